// Makes, changes and removes users and tokens, one change after the other: checked, stored, put in force, reported. A change is in force
// when it is on the disk; the last administrator cannot be removed. A clear-text password is kept only until its hash is made.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/command.hpp"
#include "gateway/services/access/access_port.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/services/state_tag.hpp"

namespace axisgate {

/// Identifies this state of a user; a sign-in does not change it.
[[nodiscard]] std::string tag_of(const User& user);
[[nodiscard]] boost::json::object document_of(const User& user);
[[nodiscard]] boost::json::object document_of(const Token& token);

/// Reports an event of kind "access".
void note_access(AccessPort& port, Door door, std::string who, std::string text, Severity severity = Severity::info);
/// Stores last uses, in their turn behind the waiting changes. They may be lost.
void keep_uses(const std::shared_ptr<AccessPort>& port);

[[nodiscard]] ServiceRefusal too_many_passwords();
[[nodiscard]] ServiceRefusal too_many_account_changes();
[[nodiscard]] ServiceRefusal account_not_stored(const std::string& fault);

struct NewUser {
    std::string name, password;
    Role role = Role::viewer;
    bool enabled = true;
};
struct UserChange {
    std::optional<Role> role;
    std::optional<bool> enabled;
    std::optional<std::string> password;
};
struct NewToken {
    std::string name, owner;
    Role role = Role::viewer;
    std::optional<std::int64_t> expires_in_s;
};
struct MadeToken {
    Token token;
    std::string secret;  ///< shown once
};

/// A value, made where the port is available. Each `then` is called once, perhaps at once; `thrown` is called if the change threw.
class AccountChanges {
public:
    using Thrown = ChangeQueue::Failed;
    using UserEnd = std::function<void(Refusable<User>)>;
    using Ended = std::function<void(std::optional<ServiceRefusal>)>;
    explicit AccountChanges(std::shared_ptr<AccessPort> port) : port_(std::move(port)) {}

    /// The user, if the request refers to its present state.
    [[nodiscard]] Refusable<User> find(const std::string& name, const MeantState& meant = {}) const;
    void add_user(NewUser user, const Origin& by, std::int64_t now_unix_ns, UserEnd then, Thrown thrown) const;
    void change_user(const std::string& name, UserChange change, MeantState meant, const Origin& by, UserEnd then, Thrown thrown) const;
    void remove_user(const std::string& name, MeantState meant, const Origin& by, Ended then, Thrown thrown) const;
    /// `hash` is that of the old password, which was already verified.
    void change_password(const std::string& name, std::string password, std::string hash, const Origin& by, Ended then,
                         Thrown thrown) const;

    void add_token(NewToken wish, const Origin& by, std::int64_t now_unix_ns, std::function<void(Refusable<MadeToken>)> then,
                   Thrown thrown) const;
    void remove_token(Token token, const Origin& by, Ended then, Thrown thrown) const;

private:
    /// Applies a change to the present user and composes its event; or returns the refusal.
    using Make = std::function<std::optional<ServiceRefusal>(AccessRegister&, std::optional<User>& user, std::string& text)>;
    void change(const std::string& name, const Origin& by, Make make, std::function<void(Refusable<std::optional<User>>)> then,
                Thrown thrown) const;
    [[nodiscard]] static std::function<void(Refusable<std::optional<User>>)> as_user(UserEnd then);
    [[nodiscard]] static std::function<void(Refusable<std::optional<User>>)> as_end(Ended then);

    std::shared_ptr<AccessPort> port_;
};

}  // namespace axisgate
