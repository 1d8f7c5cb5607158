// A search for drives on a line: the addresses that a family would ask, and a report that grows. The question is the adapter's own first
// exchange with a drive, at its lowest priority: nothing is written to any drive, and polling continues.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/setup.hpp"

namespace axisgate {

struct ScanWish {
    LineKind kind = LineKind::bytes;
    std::string family;              ///< to search for; empty: each family of the line
    std::string from, to;            ///< first and last address, in the family's form; empty: all
    std::vector<std::string> known;  ///< addresses of the site's drives on this line
    Duration limit{};                ///< of the whole scan
};

/// The answer of Family::scan.
struct ScanPlan {
    std::vector<std::string> addresses;  ///< addresses to ask, in this order; the engine leaves out those of `known`
    std::size_t at_once = 1;             ///< asked at the same time, 1..16
    std::string fault;                   ///< not empty: `from` or `to` is wrong in this family, with the remedy
};

struct ScanReport {
    enum class State : std::uint8_t { none, running, done, failed, cancelled };
    struct Found {
        std::string address, family;
        std::string text;      ///< its identification
        std::string known_as;  ///< name of the site's drive at that address; empty: none
    };
    /// The progress of the search for one family.
    struct Part {
        std::string family;
        std::size_t asked = 0, of = 0;
        std::string text;  ///< the reason why it is not searched for; empty: it is
    };
    State state = State::none;
    std::size_t asked = 0, of = 0;
    std::vector<Part> parts;   ///< by family, in the order of the line; `asked` and `of` are their sums
    std::vector<Found> found;  ///< in order of discovery; the site's own drives that answer come first
    std::string text;          ///< the reason why it failed or ended early
};
[[nodiscard]] std::string_view name_of(ScanReport::State state) noexcept;

}  // namespace axisgate
