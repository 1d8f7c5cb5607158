// LinRS telegrams (01h, ID, length, 02h, sub ID, main ID, data, 04h) and the values in their answers. The end of a telegram is found by its
// length, because 01h, 02h and 04h also occur in data.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::linmot {

inline constexpr std::uint8_t start_byte = 0x01, end_byte = 0x04;  ///< of a telegram

/// The checksum after the data. Only `none` is proven on drives: covered bytes and start values of the others are not public.
struct ChecksumRule {
    enum class Kind : std::uint8_t { none, sum, crc, crc_reflected };
    Kind kind = Kind::none;
    std::uint8_t from = 0;         ///< first byte that is covered: 0 the telegram start, 3 the data start
    std::uint16_t start = 0xFFFF;  ///< of both CRCs
    [[nodiscard]] std::size_t size() const noexcept { return kind == Kind::none ? 0 : 2; }
};
/// Calculated from the first byte of the telegram to its last data byte.
[[nodiscard]] std::uint16_t checksum(std::span<const std::uint8_t> telegram, const ChecksumRule& rule) noexcept;

/// The part of a telegram between its ID and its end.
struct Telegram {
    static constexpr std::size_t most_data = 60;  ///< the length byte is 2..63; three of the counted bytes are 02h, sub ID and main ID
    std::uint8_t id = 0;
    std::uint8_t sub = 0;
    std::uint8_t main = 0;
    std::uint8_t size = 0;  ///< of the data
    std::array<std::uint8_t, most_data> storage{};

    [[nodiscard]] std::span<const std::uint8_t> data() const noexcept { return {storage.data(), size}; }
    void add(std::uint8_t byte) noexcept {
        if (size < most_data) storage[size++] = byte;
    }
    void add16(std::uint32_t value) noexcept {
        add(static_cast<std::uint8_t>(value));
        add(static_cast<std::uint8_t>(value >> 8));
    }
    void add32(std::uint32_t value) noexcept {
        add16(value);
        add16(value >> 16);
    }
    /// Low byte first; missing bytes count as 0.
    [[nodiscard]] std::uint16_t u16(std::size_t at) const noexcept;
    [[nodiscard]] std::uint32_t u32(std::size_t at) const noexcept { return std::uint32_t{u16(at)} | std::uint32_t{u16(at + 2)} << 16; }
    bool operator==(const Telegram& o) const noexcept;
};
[[nodiscard]] std::vector<std::uint8_t> pack(const Telegram& telegram, const ChecksumRule& rule);
/// Length of a telegram with `data` bytes of data.
[[nodiscard]] inline std::size_t wire_size(std::size_t data, const ChecksumRule& rule) noexcept { return data + 7 + rule.size(); }

/// Finds telegrams in a byte stream. Bytes that belong to no telegram are passed on with the reason.
class Framer {
public:
    using OnTelegram = std::function<void(const Telegram&, std::span<const std::uint8_t> bytes)>;
    using OnJunk = std::function<void(std::span<const std::uint8_t> bytes, std::string_view why)>;

    void set(const ChecksumRule& rule) { rule_ = rule; }
    void push(std::span<const std::uint8_t> bytes, const OnTelegram& telegram, const OnJunk& junk);
    /// The line has become silent or the time-out has expired: incomplete bytes are not a telegram.
    void reset(const OnJunk& junk = {});
    [[nodiscard]] bool pending() const noexcept { return !held_.empty(); }

private:
    void look(const OnTelegram& telegram, const OnJunk& junk);
    ChecksumRule rule_;
    std::vector<std::uint8_t> held_;  ///< at most one telegram of maximum length and the bytes after it of the same run
};

// --- message IDs (main ID, sub ID) --------------------------------------------------------------------------------------
enum class Main : std::uint8_t {
    response = 0,
    control_word = 1,
    motion = 2,
    ram = 3,
    curves = 4,
    parameters = 5,
    program = 6,
    errors = 7,
    table = 8
};

[[nodiscard]] Telegram request(std::uint8_t id, Main main, std::uint8_t sub);
[[nodiscard]] Telegram request16(std::uint8_t id, Main main, std::uint8_t sub, std::uint16_t value);
[[nodiscard]] Telegram request48(std::uint8_t id, Main main, std::uint8_t sub, std::uint16_t index, std::uint32_t value);

// --- answers --------------------------------------------------------------------------------------------------------------
/// The default response in the form of new drives. Its content can be configured in the drive, which changes its length.
struct Status {
    std::uint8_t communication = 0;
    std::uint16_t status = 0;
    std::uint16_t state_var = 0;
    std::int32_t position = 0;  ///< 0.1 um
    bool placed = true;         ///< the telegram contains the position
    [[nodiscard]] std::uint8_t state() const noexcept { return static_cast<std::uint8_t>(state_var >> 8); }
    [[nodiscard]] std::uint8_t sub_state() const noexcept { return static_cast<std::uint8_t>(state_var); }
    [[nodiscard]] bool bit(int n) const noexcept { return (status >> n & 1) != 0; }
    /// In state 8 from StateVar, where they belong to the count beside them; the status word may be older [L201-206].
    [[nodiscard]] bool moving() const noexcept { return state() == 8 ? (sub_state() & 0x20) != 0 : bit(13); }
    [[nodiscard]] bool in_target() const noexcept { return state() == 8 ? (sub_state() & 0x40) != 0 : bit(10); }
};
inline constexpr std::size_t default_size = 9;  ///< data of the default response
inline constexpr std::size_t ram_size = 13;     ///< the same, followed by the value of a RAM read
inline constexpr std::size_t warn_size = 13;    ///< inferred: followed by the warn word and two bytes of unknown meaning
/// Other configurations of the response, by their size; their parts have the order of the LinUDP answer of the same drives.
inline constexpr std::size_t size_without_position = 5;  ///< ends after the StateVar
inline constexpr std::size_t size_with_demand = 13;      ///< the demand position follows the actual position
inline constexpr std::size_t size_with_warn = 17;        ///< after that current and warn word
inline constexpr std::size_t value_size = 4;             ///< of a RAM read, behind the response
/// UPID of the actual position, 0.1 um (public report: configurations of the same maker's A1100).
inline constexpr std::uint16_t upid_position = 0x1B8D;
/// Of a default response, or of a telegram that begins with one. `base` is the size of the drive's response: with size_without_position the
/// status has no position.
[[nodiscard]] std::optional<Status> status_of(const Telegram& t, std::size_t base = default_size) noexcept;

/// Answer of the parameter, curve and command table groups.
struct ConfigAnswer {
    std::uint8_t sub = 0;
    std::uint8_t communication = 0;
    std::uint16_t index = 0;  ///< UPID, curve or entry
    std::uint32_t value = 0;
};
[[nodiscard]] std::optional<ConfigAnswer> config_of(const Telegram& t) noexcept;

/// "ok", "range", "the motion control software is not stopped", "code 9Ah".
[[nodiscard]] std::string communication_text(std::uint8_t code);
/// Name of a parameter type: "UINT16".
[[nodiscard]] std::string_view type_name(std::uint8_t code) noexcept;

// --- states and bits ------------------------------------------------------------------------------------------------------
namespace state {
inline constexpr std::uint8_t not_ready = 0, disabled = 1, ready = 2, setup_error = 3, error = 4, tests = 5, ready_to_operate = 6,
                              enabled = 8, homing = 9, initial = 11, aborting = 12, freezing = 13, quick_stop = 14, last = 20;
}
namespace bit {  // of the status word
inline constexpr int enabled = 0, error = 3, locked = 6, warning = 7, in_target = 10, homed = 11, fatal = 12, moving = 13;
}
inline constexpr std::uint16_t cw_off = 0x003E, cw_on = 0x003F, cw_quick_stop = 0x0004, cw_abort = 0x0010, cw_acknowledge = 0x0080,
                               cw_home = 0x0800;
inline constexpr std::uint8_t finished = 0x0F;  ///< sub state of a completed state

}  // namespace axisgate::linmot
