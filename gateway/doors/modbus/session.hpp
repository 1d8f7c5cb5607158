// One client's conversation: bytes in, answers out, in the order of its requests, without socket and clock. Bounds: 8320 bytes of requests
// not yet begun, 32 outstanding writes; then it takes no more bytes.
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

/// The buffer for answers, shared by all sessions of a server, because one works at a time.
struct AnswerBuffer {
    static constexpr std::size_t capacity = 64 * 1024;
    std::size_t size = 0;
    std::array<std::uint8_t, capacity> bytes;
    [[nodiscard]] std::size_t room() const noexcept { return capacity - size; }
};

class Session;
/// Is informed when a session that waited for results can continue.
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
        need_bytes,         ///< everything is begun; nothing or less than one ADU is left
        waits_for_results,  ///< the next request must wait for earlier writes; wake() will be called
        output_full,        ///< send `out`, then call work again
        not_modbus          ///< the stream cannot be used from here on: send `out` and close
    };
    /// Appends answers to `out` and begins requests, as far as possible.
    [[nodiscard]] Work work(Instant now, AnswerBuffer& out);

    /// Number of writes without an answer.
    [[nodiscard]] std::size_t in_flight() const noexcept { return count_; }
    /// Number of whole requests that work() has taken so far.
    [[nodiscard]] std::uint64_t requests() const noexcept { return requests_; }
    /// Number of requests that the last work() answered without waiting for a drive.
    [[nodiscard]] std::uint64_t answered_at_once() const noexcept { return at_once_; }
    [[nodiscard]] std::uint64_t writes() const noexcept { return writes_; }
    [[nodiscard]] std::uint64_t exceptions() const noexcept { return exceptions_; }
    [[nodiscard]] const std::string& who() const noexcept { return *client_.who; }
    /// The stream ended within a request: work() returned need_bytes and some bytes are left.
    [[nodiscard]] bool holds_partial() const noexcept { return partial_; }

    /// True if this client commands: a write is outstanding, or an axis to which it has written moves under Modbus' authority. Such a
    /// client is neither closed for being idle nor for another one.
    [[nodiscard]] bool commands_now(const Image& image) const;
    /// A write of this client was carried out on an axis.
    [[nodiscard]] bool has_commanded() const noexcept { return commanded_.any(); }
    /// The client has gone: its writes continue without an answer, and the Responder is not used again.
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
