// PKI: the certificates of a DDS domain: an authority, what its members must keep to, and for each member who it is and what it may.
// In: a folder, names, roles, the time. Out: folders for [dds] security, or a fault. Never writes over what is there, and no key that
// others can read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

struct PkiOptions {
    std::string dir;                 ///< of the authority; each member has a folder below it
    std::vector<std::string> names;  ///< of members, as [dds] name; 1..63 letters, digits, - _ .
    std::string role = "gateway";    ///< gateway, commander (commands and sees) or viewer (sees)
    std::string partition = "plant";
    std::int64_t days = 3650;  ///< for which what is made holds, 1..36500; it begins two days back, because clocks differ
};

struct PkiMade {
    std::vector<std::string> folders;  ///< in the order of the names
    bool authority = false;            ///< it was made as well
    std::string fault;                 ///< empty: good
};
/// Makes the authority where there is none, and each member that is not there yet; one that is there is a fault.
[[nodiscard]] PkiMade make_pki(const PkiOptions& options, std::int64_t now_unix_s);

/// DDS Security's documents, unsigned, for the domains 0 to 230: all is encrypted, and who shows no certificate is not talked to.
[[nodiscard]] std::string governance_document();
[[nodiscard]] std::string permissions_document(std::string_view name, std::string_view role, std::string_view partition,
                                               std::int64_t from_unix_s, std::int64_t to_unix_s);

}  // namespace axisgate
