// The only user of Cyclone DDS: one participant with the topics of schema/axisgate.idl, and their quality of service in one table. The
// library's threads only call `wake`; received samples wait in the readers' bounded caches, and ended writers in a bounded list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "axisgate.h"

namespace axisgate::dds {

struct BusSettings {
    std::uint32_t domain = 0;           ///< 0..232
    std::string partition = "plant";    ///< participants of other partitions see nothing of it
    std::string interface_name = "lo";  ///< network interface; "lo": this machine only, without multicast
    std::string security{};             ///< folder with certificates and signed permissions; empty: no security
    std::string gateway{};              ///< the gateway whose commands, parameter writes and set-points are received; empty: all
};

enum class Topic : std::uint8_t { gateway_state, axis_state, event, axis_command, command_result, parameter_write, set_point };
inline constexpr std::size_t topic_count = 7;

template <class T>
inline constexpr Topic topic_of = Topic{topic_count};
template <>
inline constexpr Topic topic_of<axisgate_GatewayState> = Topic::gateway_state;
template <>
inline constexpr Topic topic_of<axisgate_AxisState> = Topic::axis_state;
template <>
inline constexpr Topic topic_of<axisgate_Event> = Topic::event;
template <>
inline constexpr Topic topic_of<axisgate_AxisCommand> = Topic::axis_command;
template <>
inline constexpr Topic topic_of<axisgate_CommandResult> = Topic::command_result;
template <>
inline constexpr Topic topic_of<axisgate_ParameterWrite> = Topic::parameter_write;
template <>
inline constexpr Topic topic_of<axisgate_SetPoint> = Topic::set_point;

/// The lease within which the end of a gateway is noticed.
inline constexpr std::int64_t lease_ms = 2000;

class Bus {
public:
    /// `wake` is called on the library's threads when samples can be taken; it may only inform another thread.
    explicit Bus(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~Bus() { close(); }
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    /// Joins the domain, writing and reading these topics. Empty if it is open, otherwise the fault and the remedy.
    [[nodiscard]] std::string open(const BusSettings& settings, std::initializer_list<Topic> writes, std::initializer_list<Topic> reads);
    /// Leaves the domain: others see the end of its states at once.
    void close();
    [[nodiscard]] bool is_open() const noexcept { return participant_ > 0; }

    /// Returns false if it could not be written (a reader that is too slow, for longer than a millisecond).
    template <class T>
    bool write(const T& sample) {
        return write_raw(topic_of<T>, &sample, false);
    }
    /// The instance with this sample's key has ended.
    template <class T>
    bool dispose(const T& key) {
        return write_raw(topic_of<T>, &key, true);
    }
    /// The properties of a sample.
    struct Seen {
        bool valid = true;  ///< false: only the key is valid, because the instance has ended
        bool alive = true;  ///< false: disposed, or without a writer
        std::uint64_t writer = 0;
    };
    /// Takes at most `most` (64 at once) samples; returns their number. `each` must not take of the same topic.
    template <class T, class Each>
    std::size_t take(std::size_t most, Each each) {
        return take_raw(topic_of<T>, most, [&each](const void* sample, const Seen& seen) { each(*static_cast<const T*>(sample), seen); });
    }
    /// Number of samples that found no space, or were lost, since the bus was opened, for all readers together.
    [[nodiscard]] std::uint64_t turned_away() const;
    /// A writer of another participant for a topic of commands: axis commands or parameter writes.
    struct Writer {
        Topic topic = Topic::axis_command;
        std::uint64_t handle = 0;  ///< Seen::writer
        bool operator==(const Writer&) const = default;
    };
    static constexpr std::size_t gone_most = 1024;
    /// The writers that have ended since the last call: closed, their participant silent for longer than its lease, or silent for longer
    /// than their own liveliness. `wake` announces them, too. If there were more than are kept, those of `known` that have ended.
    [[nodiscard]] std::vector<Writer> take_gone(const std::function<std::vector<Writer>()>& known);
    [[nodiscard]] bool is_there(const Writer& writer) const;
    /// The origin of a writer according to its participant: "192.0.2.7, press-2, process 4711"; empty: unknown, or ended.
    [[nodiscard]] std::string whereabouts(const Writer& writer) const;
    /// Called by the library's listeners.
    void on_data() const { wake_(); }
    void on_writer_gone(std::int32_t reader, std::uint64_t handle);

private:
    [[nodiscard]] std::string add(Topic topic, const BusSettings& settings, bool writes, bool reads);
    bool write_raw(Topic topic, const void* sample, bool ended);
    std::size_t take_raw(Topic topic, std::size_t most, const std::function<void(const void*, const Seen&)>& each);

    std::function<void()> wake_;
    using Entity = std::int32_t;  // dds_entity_t: greater than 0, or an error
    Entity domain_ = 0, participant_ = 0, publisher_ = 0, subscriber_ = 0;
    Entity participants_ = 0;  // reads the participants of the domain
    std::array<Entity, topic_count> writers_{}, readers_{};
    std::mutex gone_mutex_;  // for the reports of the library's threads about writers
    std::vector<Writer> gone_;
    bool gone_more_ = false;
    std::string gateway_;  // outlives the readers that use it
};

/// Copies a text into a bounded one of the IDL; the rest is cut off, never inside a UTF-8 character.
template <std::size_t n>
void put_text(char (&into)[n], std::string_view text) {
    std::size_t length = text.size() < n ? text.size() : n - 1;
    while (length > 0 && length < text.size() && (static_cast<unsigned char>(text[length]) & 0xC0u) == 0x80u)
        --length;
    text.copy(into, length);
    into[length] = 0;
}

}  // namespace axisgate::dds
