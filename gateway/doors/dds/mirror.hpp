// The fleet's end of a mirror line: it answers questions about axes of other gateways and passes their commands to the fleet, each with one
// answer. Axes of this gateway and mirrors are refused, so that no command can return to its origin.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "gateway/doors/dds/fleet.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::dds {

class Mirror {
public:
    static constexpr std::size_t watched_most = 1024;                       ///< axes; further ones are reported as gone
    static constexpr Duration watched_for = std::chrono::seconds(30);       ///< after the last question for its state
    static constexpr Duration wait_least = std::chrono::milliseconds(100);  ///< for a command's result, whatever its request contains

    Mirror(Fleet& fleet, std::function<void(const std::string&)> send) : fleet_(fleet), send_(std::move(send)) {}

    void receive(std::string_view bytes, std::int64_t now_unix_ns, Instant now);
    /// A state of this axis has reached the fleet, or has ended.
    void on_axis(std::string_view gateway, std::string_view axis, std::int64_t now_unix_ns);
    /// Reports axes whose gateway is lost, and forgets those that are not requested any more.
    void on_turn(std::int64_t now_unix_ns, Instant now);
    [[nodiscard]] std::size_t watched() const noexcept { return watched_.size(); }

private:
    struct Watched {
        Instant asked{};
        std::uint64_t waits = 0;  ///< number of a question that waits for a state that is new enough; 0: none
        bool published = false;   ///< the last message was a state, and not that there is none
    };
    void request(const mirror::Telegram& telegram, std::int64_t now_unix_ns, Instant now);
    void tell(const std::string& address, Watched& watched, std::uint64_t number, std::int64_t now_unix_ns);
    void answer(const mirror::Telegram& request, const mirror::Answer& answer);
    [[nodiscard]] mirror::Answer read(const std::string& address, const std::string& name, std::int64_t now_unix_ns) const;
    [[nodiscard]] Fleet::Seen seen(std::string_view address) const;

    Fleet& fleet_;
    std::function<void(const std::string&)> send_;
    mirror::Framer framer_;
    std::map<std::string, Watched, std::less<>> watched_;  // by address
    std::uint64_t comings_ = 0;                            // number of changes of gateways at the last look
    std::shared_ptr<char> alive_ = std::make_shared<char>();
};

}  // namespace axisgate::dds
