// Frames of one line as sentences of the family's decoder, in their order; no sentence while a message is incomplete. Cable and twin bus
// are kept apart. After a gap in the recording a new decoder must be made.
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
    /// For the line of that name in the site; decodes nothing if there is none, or if its families have no decoders.
    FrameDecoder(const Families& families, const Site& site, std::string_view line);
    /// On a line of several families each sentence begins with the family to which the frame belongs. A frame that belongs to none (a
    /// broadcast of the gateway) is decoded by those families that know it.
    [[nodiscard]] std::vector<std::string> read(const TraceEntry& entry);

private:
    struct Reader {
        FamilyEntry family;
        bool receives_all = true;
        std::vector<CanIdentifiers> identifiers{};
        std::array<std::unique_ptr<Decoder>, 4> decoders{};  ///< cable and twin bus, CAN and bytes; made when needed
    };
    [[nodiscard]] static std::vector<std::string> read_as(Reader& reader, const TraceEntry& entry);

    std::vector<Reader> readers_;
};

}  // namespace axisgate
