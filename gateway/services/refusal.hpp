// The refusal of a service as a value, which each door expresses in the words of its own protocol: the reason, the axis, the faulty places
// of a document, the present state. It contains no status, header or other word of one protocol.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/services/fault.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

struct ServiceRefusal {
    enum class Why : std::uint8_t {
        not_found,       ///< the name does not exist
        unknown_point,   ///< the family has no such parameter
        unreadable,      ///< the input does not have the claimed form
        invalid,         ///< it can be read, and is wrong: see `faults`
        out_of_range,    ///< a value that the catalogue does not allow
        not_writable,    ///< it can only be read
        conflict,        ///< it conflicts with the present state
        overtaken,       ///< it refers to another state than the present one
        stage_taken,     ///< another client's site is staged
        stage_replaced,  ///< the staged site is not the one that was named
        too_many,        ///< the maximum number exists already
        in_use,          ///< another client is using this very object now
        running,         ///< a recipe is running
        not_simulated,   ///< a real drive serves it, or none
        wrong_state,     ///< not possible in the present state
        overloaded,      ///< the gateway has too much to do
        no_answer,       ///< the drive, or another part that had to answer, did not answer
        not_stored,      ///< the disk did not accept it
    };
    Why why = Why::conflict;
    std::string text;
    std::string axis{};
    std::vector<Fault> faults{};
    boost::json::object more{};  ///< further members of the answer
    std::string tag{};           ///< overtaken: the tag of the present state (state_tag.hpp); empty: there is none any more
    std::uint64_t revision = 0;  ///< of the site in force, if it has changed meanwhile
};

/// The result, or the refusal.
template <class T>
using Refusable = std::variant<T, ServiceRefusal>;

/// "there is no axis slide".
[[nodiscard]] ServiceRefusal no_such(std::string_view what, std::string_view name);
/// The first fault as text, with the number of the others; `more` counts those that are not in the list.
[[nodiscard]] std::string first_of(const std::vector<Fault>& faults, std::size_t more = 0);
/// Invalid because of these faults.
[[nodiscard]] ServiceRefusal faulty(std::vector<Fault> faults, std::string_view axis = {},
                                    ServiceRefusal::Why why = ServiceRefusal::Why::invalid);
/// Faults of a site as faults of the input: their pointers begin behind `entry` ("/axes/2") if they point into it.
[[nodiscard]] std::vector<Fault> faults_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document);
/// A conflict if the only fault is that a place is taken; otherwise invalid.
[[nodiscard]] ServiceRefusal refusal_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document);

}  // namespace axisgate
