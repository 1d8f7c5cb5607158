// Random ids, their digests, password hashes (argon2id) and the rules for passwords and names. Digests and hashes may be stored; ids and
// codes are shown once. derive_password and password_fits take 0.1 to 1 s and must not run on a thread for which others wait.
#pragma once

#include <string>
#include <string_view>

namespace axisgate {

/// 256 random bits, in URL-safe base64 (43 characters).
[[nodiscard]] std::string random_secret();
/// 80 random bits for people to type: "K7QF-2M9D-XW3E-8HTR" (no I, L, O, U).
[[nodiscard]] std::string random_code();
/// A typed code in the form that is digested: upper case, without blanks and hyphens, I and L as 1, O as 0.
[[nodiscard]] std::string plain_code(std::string_view typed);
/// 64 hex digits (BLAKE2b-256). For secrets that are random themselves; passwords need derive_password.
[[nodiscard]] std::string digest_of(std::string_view secret);
/// In constant time for texts of one length.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b) noexcept;

/// argon2id with libsodium's interactive limits; empty if there is not enough memory.
[[nodiscard]] std::string derive_password(const std::string& password);
[[nodiscard]] bool password_fits(const std::string& password, const std::string& hash);
/// A hash that no password fits and that takes as long to verify as a real one, so that an unknown user cannot be recognized by the
/// response time.
extern const std::string_view hash_of_nobody;

/// Empty if the password is good; otherwise the fault as a sentence.
[[nodiscard]] std::string password_fault(std::string_view password, std::string_view user);
[[nodiscard]] std::string user_name_fault(std::string_view name);

}  // namespace axisgate
