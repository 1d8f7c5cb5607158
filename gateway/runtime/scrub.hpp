// Removes secrets from a text of any kind (TOML, JSON, a log): passwords, tokens, keys, sign-in codes are replaced by "(removed)". In doubt
// it removes too much.
#pragma once

#include <string>
#include <string_view>

namespace axisgate {

/// The removed parts are: the value after a name with password, passphrase, secret, token, cookie, session, authorization, credential or
/// psk in it and a colon or an equals sign, up to the end of the quoted text or of the word; whole PEM blocks; user and password in URLs;
/// codes of the first sign-in (four groups of four); runs of 40 or more characters of base64 or hex.
[[nodiscard]] std::string scrub(std::string_view text);

}  // namespace axisgate
