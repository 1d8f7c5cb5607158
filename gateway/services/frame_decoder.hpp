// Frame decoder: the frames of one line as sentences, in the order in which they crossed it.
// In: recorded frames. Out: the family's reading of each (none where a message is not whole yet). Cable and twin bus are kept apart.
// Never keeps a frame; after a gap in the recording it must be made anew.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/family.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

class FrameDecoder {
public:
    /// For the line of that name in the site; reads nothing if there is none, or if its families have no readers.
    FrameDecoder(const Families& families, const Site& site, std::string_view line);
    /// On a line of several families each sentence begins with the family that claims the frame. What none claims (a broadcast of the
    /// gateway) is read by those that know it.
    [[nodiscard]] std::vector<std::string> read(const TraceEntry& entry);

private:
    struct Reader {
        FamilyEntry family;
        bool receives_all = true;
        std::vector<CanIdentifiers> identifiers{};
        std::array<std::unique_ptr<Decoder>, 4> decoders{};  ///< cable and twin bus, CAN and bytes; made when they are needed
    };
    [[nodiscard]] static std::vector<std::string> read_as(Reader& reader, const TraceEntry& entry);

    std::vector<Reader> readers_;
};

}  // namespace axisgate
