// Authority: who commands an axis: a lease that one client holds, that expires, and that can be handed over or taken over.
// In: requests with the client's stable name and the moment. Out: the state of one axis, and whether a client may command it, or why not.
// Never has a clock: what has expired is found out when it is asked for, or in expire(). Bounded: one holder per axis, one name each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/command.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/site/authority_mode.hpp"

namespace axisgate {

/// A client that can hold an axis: its door and its stable name. Two connections with the same name are one client: a Modbus client is its
/// host, because a PLC comes from another port after each interruption.
struct AuthorityClient {
    Door door = Door::none;
    std::string name;
    [[nodiscard]] static AuthorityClient of(const Origin& origin);
    [[nodiscard]] std::string text() const;  ///< "modbus 192.0.2.7"
    bool operator==(const AuthorityClient&) const = default;
};

class AxisAuthority {
public:
    static constexpr std::size_t name_most = 63;  ///< bytes of a client's name; longer ones are cut off

    enum class Change : std::uint8_t { none, taken, renewed, released, expired, taken_over, handed_over, commander };
    struct Verdict {
        bool allowed = true;
        Change change = Change::none;
        std::string text;  ///< refused: who holds it, for how long still, what to do; else what has changed
    };

    /// A command (not a stop: that is never asked for). Takes or renews a lease where the mode says so.
    [[nodiscard]] Verdict command(const AuthorityClient& who, AuthorityMode mode, Duration lease, Instant now);
    /// Whether this client would be allowed to; changes nothing.
    [[nodiscard]] Verdict may(const AuthorityClient& who, Instant now) const;
    [[nodiscard]] Verdict take(const AuthorityClient& who, Duration lease, bool take_over, Instant now);
    /// The holder gives it up; anybody may release what nobody holds.
    [[nodiscard]] Verdict release(const AuthorityClient& who, Instant now);
    /// The holder names the next one, "DOOR NAME" or NAME alone (then of the same door). It has `lease` from now on. Who is named by the
    /// user alone ("http anne") is whichever client of that user comes first ("anne page-3f"): it holds the axis from then on.
    [[nodiscard]] Verdict hand_over(const AuthorityClient& who, std::string_view to, Duration lease, Instant now);
    /// Ends a lease whose time is over.
    [[nodiscard]] Verdict expire(Instant now);

    [[nodiscard]] bool held(Instant now) const noexcept { return holder_.door != Door::none && now < until_; }
    [[nodiscard]] const AuthorityClient& holder() const noexcept { return holder_; }  ///< door none: nobody
    [[nodiscard]] const AuthorityClient& commander() const noexcept { return commander_; }
    /// Grows whenever holder or commander is another.
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
    [[nodiscard]] Instant since() const noexcept { return since_; }
    [[nodiscard]] Instant until() const noexcept { return until_; }
    /// For register 17: the holder's door; while nobody holds it the one that commanded last, unless that was a holder whose lease has
    /// ended.
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
    bool for_any_of_user_ = false;  ///< handed over, and not used yet
    bool given_up_ = false;         ///< who commanded last held it then, and does not any more
};

}  // namespace axisgate
