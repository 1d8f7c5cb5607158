// The certificates of a DDS domain: an authority, the rules for its members, and for each member its identity and permissions, as folders
// for [dds] security. Existing files are never overwritten, and keys are readable only by their owner.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

struct PkiOptions {
    std::string dir;                 ///< of the authority; each member has a folder below it
    std::vector<std::string> names;  ///< of members, as in [dds] name; 1..63 letters, digits, - _ .
    std::string role = "gateway";    ///< gateway, commander (commands and sees) or viewer (sees)
    std::string partition = "plant";
    std::int64_t days = 3650;  ///< duration of validity, 1..36500; it begins two days back, because clocks differ
};

struct PkiMade {
    std::vector<std::string> folders;  ///< in the order of the names
    bool authority = false;            ///< the authority was made as well
    std::string fault;                 ///< empty: good
};
/// Makes the authority if there is none, and each new member; an existing member is a fault.
[[nodiscard]] PkiMade make_pki(const PkiOptions& options, std::int64_t now_unix_s);

/// DDS Security's documents, unsigned, for the domains 0 to 230: everything is encrypted, and participants without a certificate are
/// refused.
[[nodiscard]] std::string governance_document();
[[nodiscard]] std::string permissions_document(std::string_view name, std::string_view role, std::string_view partition,
                                               std::int64_t from_unix_s, std::int64_t to_unix_s);

}  // namespace axisgate
