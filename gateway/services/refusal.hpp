// Service refusal: why a service did not do what it was asked, as a value that each door says in the words of its own protocol.
// In: made by the service that refuses. Out: what is wrong, with which axis, the faulty places of a document, what is there instead.
// Never a status, a header or another word of one protocol.
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
        not_found,       ///< there is nothing of that name
        unknown_point,   ///< its family has no such parameter
        unreadable,      ///< what was sent is not what it claims to be
        invalid,         ///< it can be read, and is wrong: see `faults`
        out_of_range,    ///< a value that the catalogue does not allow
        not_writable,    ///< it can only be read
        conflict,        ///< it does not fit what is there
        overtaken,       ///< it was meant for another state than the one that is there
        stage_taken,     ///< another client's site is staged
        stage_replaced,  ///< the site that is staged is another than the one that was meant
        too_many,        ///< there are as many as may be
        in_use,          ///< somebody is at this very thing just now
        running,         ///< a recipe is running
        not_simulated,   ///< a real drive serves it, or none
        wrong_state,     ///< not in the state that it is in now
        overloaded,      ///< the gateway has too much to do
        no_answer,       ///< the drive, or whoever had to say, did not answer
        not_stored,      ///< the disk did not take it
    };
    Why why = Why::conflict;
    std::string text;
    std::string axis{};
    std::vector<Fault> faults{};
    boost::json::object more{};  ///< further members of what is told
    std::string tag{};           ///< overtaken: the state that is there now (state_tag.hpp); empty: there is nothing any more
    std::uint64_t revision = 0;  ///< of the site in force, where it is what has overtaken
};

/// What was asked for, or why not.
template <class T>
using Refusable = std::variant<T, ServiceRefusal>;

/// "there is no axis slide".
[[nodiscard]] ServiceRefusal no_such(std::string_view what, std::string_view name);
/// The first fault in words, with the number of the others; `more`: of those that are not in the list.
[[nodiscard]] std::string first_of(const std::vector<Fault>& faults, std::size_t more = 0);
/// Invalid by these faults.
[[nodiscard]] ServiceRefusal faulty(std::vector<Fault> faults, std::string_view axis = {},
                                    ServiceRefusal::Why why = ServiceRefusal::Why::invalid);
/// Faults of a site as faults of what was sent: their pointers begin behind `entry` ("/axes/2") where they point into it.
[[nodiscard]] std::vector<Fault> faults_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document);
/// A conflict if all there is to say is that a place is taken; else invalid.
[[nodiscard]] ServiceRefusal refusal_for(const std::vector<SiteFault>& faults, std::string_view entry, bool whole_document);

}  // namespace axisgate
