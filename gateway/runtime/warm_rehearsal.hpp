// The rehearsal port: plays each cell and each specimen on a thread of its own, which gives way to all others. At its end the service waits
// for one cell at most; a specimen is given up.
#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

class WarmRehearsal final : public RehearsalPort {
public:
    WarmRehearsal(const WarmThreads& threads, const Families& families) : threads_(threads), families_(families) {}
    ~WarmRehearsal() override;
    WarmRehearsal(const WarmRehearsal&) = delete;
    WarmRehearsal& operator=(const WarmRehearsal&) = delete;

    /// The values of the gateway's configuration.
    void set_times(Duration watchdog, Duration lease) {
        watchdog_ = watchdog;
        lease_ = lease;
    }
    void rehearse(std::shared_ptr<const SiteState> site, RehearsalWish wish, std::function<void(RehearsalCell)> then) override;
    void aside(std::shared_ptr<const SiteState> site, const std::string& drive, std::function<void(const NonVolatile&)> work,
               std::function<void()> then) override;
    [[nodiscard]] Duration watchdog() const override { return watchdog_; }
    void prepare_recipe(RecipeRehearsalWish wish, Prepared then) override;
    void rehearse_recipe(std::shared_ptr<const RecipeRehearsal> rehearsal, std::string specimen,
                         std::shared_ptr<const std::atomic<bool>> ended, std::function<void(RehearsedSpecimen)> then) override;

private:
    const WarmThreads& threads_;
    const Families& families_;
    Duration watchdog_ = std::chrono::seconds(5), lease_ = std::chrono::seconds(30);
    boost::asio::thread_pool thread_{1};
};

}  // namespace axisgate
