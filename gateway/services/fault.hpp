// One wrong place of a document that a client sent: the fault and the remedy as text.
#pragma once

#include <string>

namespace axisgate {

struct Fault {
    std::string pointer;  ///< JSON pointer
    std::string text;     ///< the fault
    std::string remedy;   ///< the remedy
    bool in_body = true;  ///< the pointer refers to the request's body; false: to the resulting site
};

}  // namespace axisgate
