// Decoder of LinRS: recorded bytes as one readable line per telegram, down to the named motion command.
// In: runs of bytes in order, with their direction if it is known; a recording may begin and end within a telegram. Out: text; what is
// inferred is said to be so.
// Never changes anything and never guesses silently.
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

    /// A telegram in words. Answers have main ID 0; requests for a response have it, too, and no data.
    [[nodiscard]] std::string describe(const Telegram& telegram, std::optional<bool> to_drive) const;

private:
    [[nodiscard]] std::string request_text(const Telegram& t) const;
    [[nodiscard]] std::string answer_text(const Telegram& t) const;
    [[nodiscard]] std::string parameter_name(std::uint16_t upid) const;
    const Catalogue& catalogue_;
    Motions motions_;
    struct Stream {
        Framer framer;
        bool begun = false;                ///< what is strange is no end of a telegram that began before the recording
        std::vector<std::uint8_t> before;  ///< until then: bytes of no telegram
        std::vector<std::string> strange;  ///< ... and what is said of them if they are no end of one
    };
    static void strange(Stream& s, std::span<const std::uint8_t> bytes, std::string_view why, std::vector<std::string>& lines);
    static void begin(Stream& s, std::vector<std::string>& lines);
    std::array<Stream, 3> streams_;  // from the drive, to it, not known
};

}  // namespace axisgate::linmot
