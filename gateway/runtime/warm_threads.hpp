// The common parts of the owners of the service's ports: their executor, and the ways to the hot and the storage thread. Nothing waits.
// Bounded: the hot thread accepts a limited number of jobs; further ones are refused.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <functional>
#include <utility>

#include "gateway/runtime/cold.hpp"
#include "gateway/runtime/hot.hpp"
#include "gateway/store/reader.hpp"

namespace axisgate {

/// The text if the hot thread accepts no more jobs.
inline constexpr const char* too_much_asked = "too much is asked at once; come again in a moment";

struct WarmThreads {
    boost::asio::io_context& warm;
    Doorbell& bell;  ///< of the service thread
    Hot& hot;
    Cold& cold;
    StoreReader& reader;  ///< the service thread's own connection to the database

    /// Later, on the service thread; from any thread.
    template <class Then>
    void answer(Then then) const {
        boost::asio::post(warm, std::move(then));
    }
    /// Returns false if it accepts no more jobs now; `job` is not called then. Service thread.
    [[nodiscard]] bool on_hot(Hot::Job job) const {
        if (!hot.jobs().push(std::move(job))) return false;
        hot.jobs().announce();
        return true;
    }
    void on_cold(std::function<void(Store&)> job) const { cold.run(std::move(job)); }
};

}  // namespace axisgate
