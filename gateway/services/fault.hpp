// Fault: one wrong place of a document that somebody sent, in words.
// In: made by whoever reads the document. Out: shown by the door that it came through. Never says only that something is wrong.
#pragma once

#include <string>

namespace axisgate {

struct Fault {
    std::string pointer;  ///< JSON pointer
    std::string text;     ///< what is wrong
    std::string remedy;   ///< what to do
    bool in_body = true;  ///< the pointer points into the request's body; false: into the site that would result
};

}  // namespace axisgate
