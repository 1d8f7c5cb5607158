// An error in the form of RFC 9457: application/problem+json with type, title, status, detail, and additional members. It contains the
// drive's own code and everything that the engine reported.
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

/// Number of faults in one answer, with the number of the others; otherwise a long list could make an answer longer than the body.
inline constexpr std::size_t most_faults = 20;

struct Problem {
    unsigned status = 500;
    std::string reason;  ///< stable word: "not_found", "wrong_state"
    std::string detail;
    std::int32_t code = 0;  ///< the drive's own; 0 is shown as null
    std::string axis{};
    std::vector<Fault> faults{};  ///< the first ones are included
    std::size_t more_faults = 0;  ///< found, but not in the list
    boost::json::object more{};   ///< further members
};

[[nodiscard]] Response to_response(const Problem& problem);
/// The common case.
[[nodiscard]] Response problem(unsigned status, std::string_view reason, std::string detail);
/// 422 with the first faults; the detail is the first one, with the number of the others. `more` counts those that are not in the list.
[[nodiscard]] Response invalid(std::vector<Fault> faults, std::string_view axis = {}, std::string_view reason = "invalid",
                               std::size_t more = 0);

/// The status for a reason, as in command.hpp.
[[nodiscard]] unsigned status_of(Reason reason) noexcept;
/// The problem for the refusal of a service.
[[nodiscard]] Response problem_of(const ServiceRefusal& refusal);
/// A refused or failed command; includes ticket, result and reason, so that a client can read either form.
[[nodiscard]] Response problem_of(const Result& result, std::string_view axis, std::string_view command);
/// The number of a ticket for clients: below 2^53, increasing.
[[nodiscard]] std::int64_t shown(Ticket ticket) noexcept;

/// Words of a status code for the status line: "Not Found".
[[nodiscard]] std::string_view phrase_of(unsigned status) noexcept;

/// 200 (or another) with JSON.
[[nodiscard]] Response json_response(const boost::json::value& document, unsigned status = 200);

}  // namespace axisgate::http
