// Session: one client's conversation: its bytes in, its answers out, in the order of its requests.
// In: bytes, results of its writes. Out: answer bytes into a bounded buffer; whether it waits, and for what.
// Never touches a socket or a clock. Bounds: 8320 bytes of requests not yet begun, 32 writes on their way; then it takes no more bytes.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <string>

#include "gateway/axis/image.hpp"
#include "gateway/doors/modbus/adu_framer.hpp"
#include "gateway/doors/modbus/pdu.hpp"

namespace axisgate::modbus {

/// Where answers are put together; shared by all sessions of a server, since one works at a time.
struct AnswerBuffer {
    static constexpr std::size_t capacity = 64 * 1024;
    std::size_t size = 0;
    std::array<std::uint8_t, capacity> bytes;
    [[nodiscard]] std::size_t room() const noexcept { return capacity - size; }
};

class Session;
/// Told when a session that waited for results can go on.
struct SessionWaker {
    virtual void wake(Session& session) = 0;
    virtual ~SessionWaker() = default;
};

class Session final : public registers::WriteOwner {
public:
    static constexpr std::size_t max_in_flight = 32;

    Session(Responder& responder, SessionWaker& waker, std::shared_ptr<const std::string> who)
        : responder_(responder), waker_(waker), client_{this, std::move(who)} {}
    ~Session() override;
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    [[nodiscard]] AduFramer& input() noexcept { return framer_; }

    enum class Work : std::uint8_t {
        need_bytes,         ///< everything that was there is begun; nothing or less than one ADU is left
        waits_for_results,  ///< the next request must wait for earlier writes; wake() will be called
        output_full,        ///< send `out`, then call work again
        not_modbus          ///< the stream is worthless from here on: send what is in `out` and close
    };
    /// Appends answers to `out` and begins requests, as far as it can.
    [[nodiscard]] Work work(Instant now, AnswerBuffer& out);

    /// Writes whose answers have not been given.
    [[nodiscard]] std::size_t in_flight() const noexcept { return count_; }
    /// Whole requests that work() has taken so far.
    [[nodiscard]] std::uint64_t requests() const noexcept { return requests_; }
    /// Requests that the last work() answered without having to wait for a drive.
    [[nodiscard]] std::uint64_t answered_at_once() const noexcept { return at_once_; }
    [[nodiscard]] std::uint64_t writes() const noexcept { return writes_; }
    [[nodiscard]] std::uint64_t exceptions() const noexcept { return exceptions_; }
    [[nodiscard]] const std::string& who() const noexcept { return *client_.who; }
    /// The stream broke off within a request: work() said need_bytes and some bytes are left.
    [[nodiscard]] bool holds_partial() const noexcept { return partial_; }

    /// This client commands: a write is on its way, or an axis that it wrote to successfully moves under Modbus' authority. Such a client
    /// is neither closed for being idle nor to make room.
    [[nodiscard]] bool commands_now(const Image& image) const;
    /// A write of this client was carried out on some axis.
    [[nodiscard]] bool has_commanded() const noexcept { return commanded_.any(); }
    /// The client has gone: its writes go on, but nobody waits for them, and the Responder is not used again.
    void abandon() noexcept;

    void on_written(std::uint8_t slot, AxisId axis, Verdict verdict) override;

private:
    struct Slot {
        std::uint16_t transaction = 0;
        Instant begun{};
        LateAnswer late;
    };
    [[nodiscard]] std::size_t index(std::size_t n) const noexcept { return (head_ + n) % max_in_flight; }
    static void put_header(std::uint8_t* adu, std::uint16_t transaction, std::uint8_t unit, std::size_t pdu_size) noexcept;
    void begin(const Adu& adu, Instant now, AnswerBuffer& out);

    Responder& responder_;
    SessionWaker& waker_;
    Responder::Client client_;
    std::uint64_t requests_ = 0, writes_ = 0, exceptions_ = 0, at_once_ = 0;
    std::size_t head_ = 0;
    std::size_t count_ = 0;
    bool partial_ = false;
    std::array<Slot, max_in_flight> slots_;
    std::bitset<Image::max_axes + 1> commanded_;  // axis numbers
    AduFramer framer_;
};

}  // namespace axisgate::modbus
