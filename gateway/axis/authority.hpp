// The authority over an axis: a lease that one client holds, that expires, and that can be handed over or taken over. Requests contain the
// client's stable name and the time; there is no clock, so an expired lease is found at the next request or in expire(). Bounded: one
// holder per axis, one name each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/command.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/site/authority_mode.hpp"

namespace axisgate {

/// A client that can hold an axis: its door and its stable name. Two connections with the same name are one client. A Modbus client is its
/// host, because a PLC uses another port after each interruption.
struct AuthorityClient {
    Door door = Door::none;
    std::string name;
    [[nodiscard]] static AuthorityClient of(const Origin& origin);
    [[nodiscard]] std::string text() const;  ///< "modbus 192.0.2.7"
    bool operator==(const AuthorityClient&) const = default;
};

class AxisAuthority {
public:
    static constexpr std::size_t name_most = 63;  ///< length in bytes of a client's name; longer names are cut

    enum class Change : std::uint8_t { none, taken, renewed, released, expired, taken_over, handed_over, commander };
    struct Verdict {
        bool allowed = true;
        Change change = Change::none;
        std::string text;  ///< if refused: the holder, the remaining time and the remedy; otherwise the change
    };

    /// Checks a command and takes or renews the lease if the mode requires it. Stops are not checked.
    [[nodiscard]] Verdict command(const AuthorityClient& who, AuthorityMode mode, Duration lease, Instant now);
    /// True if the client would be allowed to command; changes nothing.
    [[nodiscard]] Verdict may(const AuthorityClient& who, Instant now) const;
    [[nodiscard]] Verdict take(const AuthorityClient& who, Duration lease, bool take_over, Instant now);
    /// Releases the lease of this holder; a lease that nobody holds may be released by any client.
    [[nodiscard]] Verdict release(const AuthorityClient& who, Instant now);
    /// Hands the lease to the named client: "DOOR NAME", or NAME for the same door. The new holder has it for `lease`. A user without a
    /// client ("http anne") stands for the first client of that user that commands ("anne page-3f"), which holds the axis from then on.
    [[nodiscard]] Verdict hand_over(const AuthorityClient& who, std::string_view to, Duration lease, Instant now);
    /// Ends an expired lease.
    [[nodiscard]] Verdict expire(Instant now);

    [[nodiscard]] bool held(Instant now) const noexcept { return holder_.door != Door::none && now < until_; }
    [[nodiscard]] const AuthorityClient& holder() const noexcept { return holder_; }  ///< door none: no holder
    [[nodiscard]] const AuthorityClient& commander() const noexcept { return commander_; }
    /// Increases whenever the holder or the commander changes.
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
    [[nodiscard]] Instant since() const noexcept { return since_; }
    [[nodiscard]] Instant until() const noexcept { return until_; }
    /// For register 17: the holder's door. Without a holder it is the door that commanded last, unless that client's lease has ended.
    [[nodiscard]] Door door() const noexcept {
        return holder_.door != Door::none ? holder_.door : given_up_ ? Door::none : commander_.door;
    }

private:
    [[nodiscard]] bool mine(const AuthorityClient& who) const noexcept;
    bool bind(const AuthorityClient& who) noexcept;
    void give(const AuthorityClient& who, Duration lease, Instant now);
    void end_lease();
    [[nodiscard]] Verdict refusal(Instant now) const;

    AuthorityClient holder_, commander_;
    std::uint64_t revision_ = 1;
    Instant since_{}, until_{};
    bool for_any_of_user_ = false;  ///< handed over to a user, and not used yet
    bool given_up_ = false;         ///< the last commander was the holder then, and is not any more
};

}  // namespace axisgate
