// Problem: an error as RFC 9457 asks for it: application/problem+json with type, title, status, detail, and what we add.
// In: what went wrong, to which axis, why, what to do. Out: a Response.
// Never loses the drive's own code, and never says less than the engine said.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/command.hpp"
#include "gateway/doors/http/message.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/site/site.hpp"

namespace axisgate::http {

[[nodiscard]] boost::json::object fault_document(const Fault& fault);

/// So many faults are told at once, with the number of the others: a list as long as a body would make an answer that is longer than it.
inline constexpr std::size_t most_faults = 20;

struct Problem {
    unsigned status = 500;
    std::string reason;  ///< stable word: "not_found", "wrong_state"
    std::string detail;
    std::int32_t code = 0;  ///< the drive's own; 0 is shown as null
    std::string axis{};
    std::vector<Fault> faults{};  ///< the first ones are told
    std::size_t more_faults = 0;  ///< found, but not kept in the list
    boost::json::object more{};   ///< further members
};

[[nodiscard]] Response to_response(const Problem& problem);
/// The common case.
[[nodiscard]] Response problem(unsigned status, std::string_view reason, std::string detail);
/// 422 with its first faults; the detail is the first one, with the number of the others. `more`: beside those in the list.
[[nodiscard]] Response invalid(std::vector<Fault> faults, std::string_view axis = {}, std::string_view reason = "invalid",
                               std::size_t more = 0);

/// The status for a reason, as command.hpp gives it.
[[nodiscard]] unsigned status_of(Reason reason) noexcept;
/// What a service has refused.
[[nodiscard]] Response problem_of(const ServiceRefusal& refusal);
/// A refused or failed command; carries ticket, result and reason too, so that a client can read either form.
[[nodiscard]] Response problem_of(const Result& result, std::string_view axis, std::string_view command);
/// The number of a ticket for clients: below 2^53, counts up.
[[nodiscard]] std::int64_t shown(Ticket ticket) noexcept;

/// Words of a status code for the status line: "Not Found".
[[nodiscard]] std::string_view phrase_of(unsigned status) noexcept;

/// 200 (or another) with JSON.
[[nodiscard]] Response json_response(const boost::json::value& document, unsigned status = 200);

}  // namespace axisgate::http
