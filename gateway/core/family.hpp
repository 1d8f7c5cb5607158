// Family: what adapters/<family> gives to the rest: its makers of adapters and twins, its decoder, what its lines are like.
// In: one `const Family& family_<name>()` per folder, collected by the generated list. Out: looked up by name.
// Never holds data about parameters: that is the catalogue's (schema/families/<name>.json).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/adapter.hpp"
#include "gateway/core/can_identifiers.hpp"
#include "gateway/core/scan.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate {

class Catalogue;

/// A maker's description of a drive as a text (an EDS or DCF file), under the name by which sites know it.
struct DescriptionText {
    std::string name;
    std::string text;
};

/// What a drive's own catalogue is made from: its family's page and what the site says of it.
struct CatalogueWish {
    const Catalogue& page;
    const std::map<std::string, std::string>& options;  ///< the drive's "options" of the site
    const DescriptionText* description = nullptr;       ///< that the site names for it; nullptr: none
};
struct OwnCatalogue {
    std::shared_ptr<const Catalogue> catalogue{};  ///< null: the family's page is the drive's
    std::string fault{};  ///< what is wrong with the options and what would be right: the site is refused; empty: nothing
};

/// Turns recorded frames into one readable line each. Has state, because some languages need the request to read the answer.
struct Decoder {
    /// One frame, or one run of bytes (which may complete none, one or several messages). `to_drive`: direction if it is known.
    /// Returns one line per message, without line ends; unknown ones are said to be so.
    virtual std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) = 0;
    /// What was begun and never ended, at the end of the recording.
    virtual std::vector<std::string> finish() = 0;
    virtual ~Decoder() = default;
};

/// What a native statement, an action or a parameter write asks of an axis, as far as its family can read it before it is sent.
struct Stated {
    enum class Kind : std::uint8_t {
        nothing,  ///< a question, a setting, a stop, or anything else that cannot begin a motion
        motion,   ///< `move` begins
        homing,   ///< a search for the zero begins
        unread    ///< it may begin a motion that cannot be read here: a program, a trigger, bytes that mean nothing to the family
    };
    Kind kind = Kind::unread;
    int channel = 0;    ///< of the axis within the drive that it concerns; 0: the axis that was addressed
    Move move{};        ///< target, speed and rates that it names, in the axis' increments
    DriveRates sets{};  ///< rates that it changes for later motions; 0: not these
};

struct Family {
    std::string_view name;  ///< folder and catalogue name: "uim342"

    /// nullptr-free makers. The catalogue outlives what they make.
    std::unique_ptr<Adapter> (*make_adapter)(const Catalogue&, LineKind);  // of the page; a drive's own is in its DriveSetup
    std::unique_ptr<Twin> (*make_twin)(const Catalogue&, const TwinSetup&);
    std::unique_ptr<Decoder> (*make_decoder)(const Catalogue&, LineKind);

    /// Empty if the address is good in the family's form, else what is wrong and what would be right.
    std::string (*check_address)(std::string_view address);
    /// The address a new drive has; used by `axisgate twin` without --address.
    std::string_view factory_address;
    /// For a serial line whose URI does not say: "57600 8N1". 0: it has no serial line.
    std::uint32_t default_bit_rate;
    std::string_view default_format;
    bool uses_can;    ///< speaks CAN frames
    bool uses_bytes;  ///< speaks on a byte line
    /// Bit rate of an embedded CAN bus whose site does not say; a real one is set outside.
    std::uint32_t default_can_bit_rate = 0;
    /// Which addresses a search for drives asks; nullptr: drives of this family cannot be searched for.
    ScanPlan (*scan)(const ScanWish&) = nullptr;
    /// Makes the catalogue of one drive where the site's options say that it has more, or other, than the family's page; nullptr: the page
    /// is every drive's. The same wish gives the same catalogue: mappings are checked against it before the site is in force.
    OwnCatalogue (*own_catalogue)(const CatalogueWish&) = nullptr;
    /// The identifiers of the frames that drives at these addresses send, and of those sent to one of them. Its adapter is given these
    /// frames and no others (reports of the controller apart), and by them a recorded frame finds its decoder. nullptr: every frame of the
    /// line; such a family cannot share a CAN line with another one.
    std::vector<CanIdentifiers> (*can_identifiers)(std::span<const std::string> addresses) = nullptr;
    /// A drive of the site may name a maker's description; own_catalogue makes the drive's catalogue of it.
    bool takes_description = false;
    /// Its drives are axes of other gateways: it stands on a line `dds` (or on `twin`) and on no other, and no other family stands there.
    bool uses_dds = false;
    /// Whose adapter serves drives of this family, together with those of that family where both stand on a line: what a line has once (the
    /// SYNC, the gateway's own node) is then one thing for all of them. It tells them apart by the catalogues in their DriveSetup.
    /// nullptr: its own.
    const Family& (*served_by)() = nullptr;
    /// Reads a Native, an Action or a WriteParameter body for the axis of this channel. Pure; never throws; what it cannot read is
    /// `unread`. nullptr: native statements and actions of this family are `unread`, parameter writes are `nothing`.
    Stated (*stated)(const Catalogue&, int channel, const CommandBody&) = nullptr;
};
[[nodiscard]] inline const Family& serving_family(const Family& f) noexcept { return f.served_by ? f.served_by() : f; }

/// Every family that was found at configure time, in order of name. (Generated.)
[[nodiscard]] std::span<const Family* const> all_families();
[[nodiscard]] const Family* find_family(std::string_view name);

}  // namespace axisgate
