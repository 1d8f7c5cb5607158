// The rules for names and passwords, and the calls of libsodium. Common passwords are recognized by rules and a short list.
#include "gateway/services/access/secrets.hpp"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <set>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
/// libsodium must be initialized once to choose its implementations; the call is safe from several threads.
[[maybe_unused]] bool ready() {
    static const bool good = sodium_init() >= 0;
    return good;
}

constexpr std::string_view code_letters = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

/// The most common passwords of sufficient length. Repetitions and sequences are recognized by rules, not by this list.
/// clang-format off
constexpr std::array<std::string_view, 24> common{"password1234",
                                                  "password12345",
                                                  "password123456",
                                                  "passwordpassword",
                                                  "adminadminadmin",
                                                  "administrator",
                                                  "administrator1",
                                                  "qwertyuiop12",
                                                  "qwertyuiop123",
                                                  "qwertyuiopasdf",
                                                  "1q2w3e4r5t6y",
                                                  "1qaz2wsx3edc",
                                                  "zaq12wsxcde3",
                                                  "letmeinletmein",
                                                  "iloveyou1234",
                                                  "welcome12345",
                                                  "changeme1234",
                                                  "changemechangeme",
                                                  "correcthorsebatterystaple",
                                                  "trustno1trustno1",
                                                  "supervisor12",
                                                  "maintenance1",
                                                  "axisgate1234",
                                                  "axisgateaxisgate"};
// clang-format on
}  // namespace

const std::string_view hash_of_nobody = "$argon2id$v=19$m=65536,t=2,p=1$AAAAAAAAAAAAAAAAAAAAAA$AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";

std::string random_secret() {
    (void)ready();
    std::array<unsigned char, 32> bytes{};
    randombytes_buf(bytes.data(), bytes.size());
    std::array<char, sodium_base64_ENCODED_LEN(32, sodium_base64_VARIANT_URLSAFE_NO_PADDING)> text{};
    sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), sodium_base64_VARIANT_URLSAFE_NO_PADDING);
    return text.data();
}

std::string random_code() {
    (void)ready();
    std::string code;
    for (int i = 0; i < 16; ++i) {
        if (i > 0 && i % 4 == 0) code += '-';
        code += code_letters[randombytes_uniform(static_cast<std::uint32_t>(code_letters.size()))];
    }
    return code;
}

std::string plain_code(std::string_view typed) {
    std::string out;
    for (char c : typed) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
        if (c == ' ' || c == '-' || c == '\t') continue;
        out += c == 'I' || c == 'L' ? '1' : c == 'O' ? '0' : c;
    }
    return out;
}

std::string digest_of(std::string_view secret) {
    (void)ready();
    std::array<unsigned char, 32> out{};
    crypto_generichash(out.data(), out.size(), reinterpret_cast<const unsigned char*>(secret.data()), secret.size(), nullptr, 0);
    std::array<char, 65> hex{};
    sodium_bin2hex(hex.data(), hex.size(), out.data(), out.size());
    return hex.data();
}

bool same_secret(std::string_view a, std::string_view b) noexcept {
    return a.size() == b.size() && !a.empty() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string derive_password(const std::string& password) {
    (void)ready();
    std::array<char, crypto_pwhash_STRBYTES> out{};
    if (crypto_pwhash_str(out.data(), password.data(), password.size(), crypto_pwhash_OPSLIMIT_INTERACTIVE,
                          crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0) {
        return {};
    }
    return out.data();
}

bool password_fits(const std::string& password, const std::string& hash) {
    (void)ready();
    if (hash.empty() || hash.size() >= crypto_pwhash_STRBYTES) return false;
    std::array<char, crypto_pwhash_STRBYTES> text{};
    std::ranges::copy(hash, text.begin());
    return crypto_pwhash_str_verify(text.data(), password.data(), password.size()) == 0;
}

std::string password_fault(std::string_view password, std::string_view user) {
    if (password.size() < 12 || password.size() > 256) return "a password has 12 to 256 characters";
    if (!is_utf8(password)) return "a password is text in UTF-8";
    const std::string low = lower(password);
    if (std::ranges::find(common, low) != common.end()) return "this password is one of those that are tried first";
    if (!user.empty() && low.find(lower(user)) != std::string::npos && password.size() < user.size() + 8) {
        return "this password is little more than the user's name";
    }
    if (std::set<char>(low.begin(), low.end()).size() < 5) return "this password has fewer than five different characters";
    int runs = 0;
    for (std::size_t i = 1; i < low.size(); ++i)
        runs += low[i] == low[i - 1] || low[i] == low[i - 1] + 1 || low[i] == low[i - 1] - 1;
    if (static_cast<std::size_t>(runs) * 10 >= (low.size() - 1) * 8) return "this password is a run such as 123456 or abcdef";
    return {};
}

std::string user_name_fault(std::string_view name) {
    const bool good = !name.empty() && name.size() <= 64 && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-' || c == '@';
    });
    if (!good) return "a user's name has 1 to 64 of the characters a-z, 0-9, . _ - @";
    if (name == "local" || name == "token" || name == "nobody") return fmt::format("the name {} has a meaning of its own", name);
    return {};
}

}  // namespace axisgate
