// Scrub: takes out of a text what must not leave the machine: passwords, tokens, keys, sign-in codes.
// In: text of any kind (TOML, JSON, a log). Out: the same with what is secret replaced by "(removed)". Never fails; takes out rather too
// much.
#pragma once

#include <string>
#include <string_view>

namespace axisgate {

/// What stands after a name with password, passphrase, secret, token, cookie, session, authorization, credential or psk in it and a colon
/// or an equals sign, up to the end of the quoted text or of the line's word; whole PEM blocks; user and password in URLs; codes of the
/// first sign-in (four groups of four); runs of 40 or more characters of base64 or hex.
[[nodiscard]] std::string scrub(std::string_view text);

}  // namespace axisgate
