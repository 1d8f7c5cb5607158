// The common parts of the handlers of sessions, users and tokens: bodies, the session's document, the answer of a door without users. A
// password is kept only for the call and until its hash is made.
#pragma once

#include <boost/json/object.hpp>

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "gateway/doors/http/handlers.hpp"
#include "gateway/services/access/account_changes.hpp"

namespace axisgate::http {

/// The members of a body; all faults together become one 422.
class BodyReader {
public:
    BodyReader(const boost::json::object& body, std::initializer_list<std::string_view> known);
    /// Empty if it is absent, or not a text of at most `most` bytes (then a fault). `needed`: absence is a fault.
    std::optional<std::string> text(std::string_view key, bool needed, std::size_t most = 1024);
    std::optional<bool> flag(std::string_view key);
    std::optional<Role> role(std::string_view key, bool needed);
    /// null counts as absent.
    std::optional<std::int64_t> whole(std::string_view key, std::int64_t low, std::int64_t high);
    void fault(std::string_view key, std::string text, std::string remedy);
    [[nodiscard]] bool good() const noexcept { return faults_.empty(); }
    [[nodiscard]] Response refusal() { return invalid(std::move(faults_), {}, "invalid", more_); }

private:
    const boost::json::object& body_;
    std::vector<Fault> faults_;
    std::size_t more_ = 0;  ///< faults beyond the limit are only counted, because the client has not signed in yet
};

/// The answer of /session.
[[nodiscard]] boost::json::object session_document(AccessPort* port, const Identity& identity);
/// 503: the door has no users; for the handlers that need them.
[[nodiscard]] Response no_accounts();
/// A promise for requests that wait for a hash and the disk.
[[nodiscard]] Handled soon();

}  // namespace axisgate::http
