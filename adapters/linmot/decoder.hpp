// The decoder of LinRS: recorded bytes as one line of text per telegram, down to the named motion command. A recording may begin and end
// within a telegram, and the direction may be unknown. Text that rests on inferred layouts says so.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/wire.hpp"
#include "gateway/core/family.hpp"

namespace axisgate::linmot {

class LineDecoder final : public Decoder {
public:
    explicit LineDecoder(const Catalogue& catalogue) : catalogue_(catalogue), motions_(catalogue) {}
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) override;
    std::vector<std::string> finish() override;

    /// The text of a telegram. Answers have main ID 0; so have requests for a response, which have no data.
    [[nodiscard]] std::string describe(const Telegram& telegram, std::optional<bool> to_drive) const;

private:
    [[nodiscard]] std::string request_text(const Telegram& t) const;
    [[nodiscard]] std::string answer_text(const Telegram& t) const;
    [[nodiscard]] std::string parameter_name(std::uint16_t upid) const;
    const Catalogue& catalogue_;
    Motions motions_;
    struct Stream {
        Framer framer;
        bool begun = false;                ///< a telegram was seen: strange bytes are no longer the end of a telegram that began before the
                                           ///< recording
        std::vector<std::uint8_t> before;  ///< until then: bytes that belong to no telegram
        std::vector<std::string> strange;  ///< ... and their descriptions, if they are not the end of a telegram
    };
    static void strange(Stream& s, std::span<const std::uint8_t> bytes, std::string_view why, std::vector<std::string>& lines);
    static void begin(Stream& s, std::vector<std::string>& lines);
    std::array<Stream, 3> streams_;  // from the drive, to the drive, unknown
};

}  // namespace axisgate::linmot
