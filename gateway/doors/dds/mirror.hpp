// Mirror: the fleet's end of a mirror line: what axes of other gateways are asked and told there, made of what the fleet knows and does.
// In: telegrams, what comes of axes and gateways, time. Out: telegrams; commands to the fleet, each with one answer.
// Never commands by itself, and never an axis of this gateway or one that is a mirror: no command can go round in a circle.
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
    static constexpr std::size_t watched_most = 1024;                       ///< axes; one more is told to be gone
    static constexpr Duration watched_for = std::chrono::seconds(30);       ///< after the last question for its state
    static constexpr Duration wait_least = std::chrono::milliseconds(100);  ///< for a command's result, whatever its request says

    Mirror(Fleet& fleet, std::function<void(const std::string&)> send) : fleet_(fleet), send_(std::move(send)) {}

    void receive(std::string_view bytes, std::int64_t now_unix_ns, Instant now);
    /// A state of this axis has come to the fleet, or has ended.
    void on_axis(std::string_view gateway, std::string_view axis, std::int64_t now_unix_ns);
    /// Tells of axes whose gateway is gone, forgets those that nobody asks for.
    void on_turn(std::int64_t now_unix_ns, Instant now);
    [[nodiscard]] std::size_t watched() const noexcept { return watched_.size(); }

private:
    struct Watched {
        Instant asked{};
        std::uint64_t waits = 0;  ///< number of a question that waits for a state that is new enough; 0: none
        bool published = false;   ///< a state was told last, and not that there is none
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
    std::uint64_t comings_ = 0;                            // of gateways, as they were counted when it was looked last
    std::shared_ptr<char> alive_ = std::make_shared<char>();
};

}  // namespace axisgate::dds
