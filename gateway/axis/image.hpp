// The newest picture of every axis. Only the engine writes it, on the hot thread; doors on the hot thread read it directly, other threads
// through the sequence lock of AxisCell. A reader always gets one complete AxisPicture.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/core/ids.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate {

enum class Presence : std::uint8_t { offline, device, twin };  ///< the side that serves the axis now

/// All values that a door can show of an axis, as plain data of fixed size.
struct AxisPicture {
    // identity (from the site)
    std::uint16_t number = 0;  ///< 1-based axis number of the register map; 0: this axis is not configured (removed)
    std::uint16_t family_number = 0;
    // reported by the drive
    std::int64_t position = 0;         ///< increments
    std::int64_t position_demand = 0;  ///< increments; equals the position unless the drive reports it or it is computed
    std::int64_t velocity = 0;         ///< increments/s
    std::uint32_t native_status = 0;
    std::uint16_t error_code = 0;  ///< the drive's own
    // CiA 402
    std::uint16_t statusword = 0;   ///< with 8 simulated, 14 stale, 15 referenced
    std::int16_t mode_display = 0;  ///< modes of operation display
    /// Register 9: 0 online, 1 simulated, 2 stale, 3 referenced, 4 moving, 5 target reached, 6 fault, 7 warning, 8 fail-safe.
    std::uint16_t flags = 0;
    /// Register 22: the LossCause for which the axis was stopped without a command, until the next command.
    std::uint16_t fail_safe_cause = 0;
    /// Register 23: bit 0 latched after a stop by another client; 1 by a fail-safe or the supervisor, 2 by another client, 3 by a safe
    /// input.
    std::uint16_t stop_latch = 0;
    // set-points as last accepted (registers 32..47 read back)
    std::uint16_t controlword = 0;
    std::int16_t mode = 0;  ///< modes of operation
    std::int32_t target_position = 0;
    std::uint32_t profile_velocity = 0;
    std::uint32_t profile_acceleration = 0;
    std::uint32_t profile_deceleration = 0;
    std::int32_t target_velocity = 0;
    std::int16_t homing_method = 0;
    std::uint16_t setpoints_accepted = 0;  ///< increases with each accepted set-point
    Door authority = Door::none;           ///< the door of the holder, or of the client that commanded last if there is no holder
    Instant authority_since{};             ///< begin and end of the holder's lease; until = the beginning of time: no holder
    Instant authority_until{};
    std::array<char, 64> authority_holder{};     ///< the holder's name, ends with 0; empty: no holder
    std::array<char, 64> authority_commander{};  ///< the client that commanded last: "modbus 192.0.2.7"
    std::array<char, 64> stop_latch_by{};        ///< the client whose stop is latched, in the same form; empty: no client
    Presence presence = Presence::offline;
    bool ever_seen = false;  ///< feedback has arrived at least once: position, velocity, error code and `at` are the last values
    DemandSource demand_source = DemandSource::none;  ///< the origin of position_demand
    bool current = false;                             ///< feedback has arrived since the serving side answered again
    Instant at{};                                     ///< when the drive reported the values
    /// Changes when another drive, channel or twin serves the axis: earlier values are not from it.
    std::uint32_t source = 0;
    /// The command whose motion the drive accepted last; no_ticket: none yet, or a stop came after it.
    Ticket motion_ticket = no_ticket;

    bool streaming = false;                                 ///< a client renews set-points (SetPoint)
    SetPoint::Mode stream_mode = SetPoint::Mode::position;  ///< their kind
    std::uint32_t set_points = 0;                           ///< streamed set-points that were passed to the drive; only increases
    std::uint32_t set_points_refused = 0;                   ///< those that were refused; only increases
    Reason set_point_refusal =
        Reason::none;  ///< the reason why the newest one was refused, or why the stream ended; none: it was passed on, or none came yet

    /// True if the demand position is known, and differs in origin from the position.
    [[nodiscard]] constexpr bool following_error_known() const noexcept {
        return demand_source == DemandSource::drive || demand_source == DemandSource::computed;
    }
    /// Demand less position (CiA 402 60F4h), increments; 0 while it is unknown.
    [[nodiscard]] constexpr std::int64_t following_error() const noexcept { return position_demand - position; }
};
static_assert(std::is_trivially_copyable_v<AxisPicture>);

inline constexpr std::uint16_t flag_online = 1u << 0, flag_simulated = 1u << 1, flag_stale = 1u << 2, flag_referenced = 1u << 3,
                               flag_moving = 1u << 4, flag_target_reached = 1u << 5, flag_fault = 1u << 6, flag_warning = 1u << 7,
                               flag_fail_safe = 1u << 8;

/// One AxisPicture behind a sequence lock, with one writer (the hot thread) and any number of readers. Readers never delay the writer.
class AxisCell {
public:
    void write(const AxisPicture& p) noexcept {
        const auto* bytes = reinterpret_cast<const unsigned char*>(&p);
        // There are no fences, because ThreadSanitizer does not know them. A reader that sees a new word also sees the odd sequence,
        // because each word is released after it; and no word is read after the second check of the sequence, because each is acquired.
        const auto s = sequence_.load(std::memory_order_relaxed);
        sequence_.store(s + 1, std::memory_order_relaxed);
        for (std::size_t i = 0; i < word_count; ++i) {
            std::uint64_t word;
            std::memcpy(&word, bytes + 8 * i, 8);
            words_[i].store(word, std::memory_order_release);
        }
        sequence_.store(s + 2, std::memory_order_release);
    }
    [[nodiscard]] AxisPicture read() const noexcept {
        std::uint64_t words[word_count];
        for (;;) {
            const auto before = sequence_.load(std::memory_order_acquire);
            for (std::size_t i = 0; i < word_count; ++i)
                words[i] = words_[i].load(std::memory_order_acquire);
            if ((before & 1u) == 0 && sequence_.load(std::memory_order_relaxed) == before) break;
        }
        AxisPicture p;
        std::memcpy(static_cast<void*>(&p), words, sizeof p);
        return p;
    }
    /// Increases with every write, so that a reader can skip a picture that it has seen.
    [[nodiscard]] std::uint64_t revision() const noexcept { return sequence_.load(std::memory_order_acquire) / 2; }

private:
    static constexpr std::size_t word_count = sizeof(AxisPicture) / 8;
    static_assert(sizeof(AxisPicture) % 8 == 0);
    std::atomic<std::uint64_t> sequence_{0};
    std::atomic<std::uint64_t> words_[word_count]{};
};

/// Cells by AxisId. Cells are never moved or removed while the process runs, so a reader may keep a reference.
class Image {
public:
    static constexpr std::size_t max_axes = axisgate::max_axes;  ///< axis numbers of the register map: 1..1024 (65536 / 64)
    static constexpr std::size_t max_ids = 16384;                ///< ids are not reused: this number of axes can be added before a restart

    /// Hot thread: the picture to read or change; publish() must be called afterwards.
    [[nodiscard]] AxisPicture& picture(AxisId id) noexcept { return chunks_[index_of(id) / chunk]->pictures[index_of(id) % chunk]; }
    [[nodiscard]] const AxisPicture& picture(AxisId id) const noexcept {
        return chunks_[index_of(id) / chunk]->pictures[index_of(id) % chunk];
    }
    void publish(AxisId id) noexcept {
        cell_of(id).write(picture(id));
        ++changes_;
    }
    /// Any thread.
    [[nodiscard]] const AxisCell& cell(AxisId id) const noexcept { return cell_of(id); }
    /// Any thread: the number of ids (0..size()-1 are valid for cell()).
    [[nodiscard]] std::size_t size() const noexcept { return size_.load(std::memory_order_acquire); }

    /// Hot thread: makes room for ids below `n` (at most `max_ids`). Returns false if this process has no more ids.
    [[nodiscard]] bool grow(std::size_t n) {
        if (n > max_ids) return false;
        const std::size_t have = size_.load(std::memory_order_relaxed);
        for (std::size_t c = 0; c * chunk < n; ++c) {
            if (!chunks_[c]) chunks_[c] = std::make_unique<Chunk>();
        }
        if (n > have) size_.store(n, std::memory_order_release);
        return true;
    }
    /// Hot thread: the axis with that number of the register map, or no_axis.
    [[nodiscard]] AxisId by_number(std::uint32_t number) const noexcept {
        return number < by_number_.size() ? by_number_[number] : no_axis;
    }
    void set_numbers(std::vector<AxisId> by_number) { by_number_ = std::move(by_number); }
    /// Hot thread: the highest axis number in use.
    [[nodiscard]] std::uint32_t last_number() const noexcept {
        return by_number_.empty() ? 0 : static_cast<std::uint32_t>(by_number_.size() - 1);
    }
    /// Hot thread: increases with every published change, for doors that cache values.
    [[nodiscard]] std::uint64_t changes() const noexcept { return changes_; }

    std::uint32_t mapping_revision = 0;  ///< register 18: hash of the site's axes and mappings

private:
    static constexpr std::size_t chunk = 64;
    struct Chunk {
        std::array<AxisCell, chunk> cells;
        std::array<AxisPicture, chunk> pictures;
    };
    [[nodiscard]] AxisCell& cell_of(AxisId id) const noexcept { return chunks_[index_of(id) / chunk]->cells[index_of(id) % chunk]; }

    std::array<std::unique_ptr<Chunk>, max_ids / chunk> chunks_;  // the chunks never move, so a reader on another thread can use them
    std::vector<AxisId> by_number_;
    std::atomic<std::size_t> size_{0};
    std::uint64_t changes_ = 0;
};

}  // namespace axisgate
