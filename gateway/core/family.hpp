// What adapters/<family> provides to the rest of the program: makers of adapters and twins, the decoder, properties of its lines. Each
// folder has one `const Family& family_<name>()`; the build generates the list. Parameters are in the catalogue
// (schema/families/<name>.json).
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

/// A maker's description of a drive as a text (an EDS or DCF file), with the name by which sites refer to it.
struct DescriptionText {
    std::string name;
    std::string text;
};

/// The input for a drive's own catalogue: its family's page and the drive's entry in the site.
struct CatalogueWish {
    const Catalogue& page;
    const std::map<std::string, std::string>& options;  ///< the drive's "options" of the site
    const DescriptionText* description = nullptr;       ///< that the site names for it; nullptr: none
};
struct OwnCatalogue {
    std::shared_ptr<const Catalogue> catalogue{};  ///< null: the family's page applies to the drive
    std::string fault{};                           ///< the fault in the options and its remedy: the site is refused; empty: none
};

/// Converts each recorded frame to one readable line. It has state, because in some languages an answer can be read only with its request.
struct Decoder {
    /// One frame, or one run of bytes (which may complete none, one or several messages). `to_drive` is the direction, if it is known.
    /// Returns one line per message, without line ends; unknown messages are reported as such.
    virtual std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) = 0;
    /// At the end of the recording: messages that were begun and never completed.
    virtual std::vector<std::string> finish() = 0;
    virtual ~Decoder() = default;
};

/// The effect of a native statement, an action or a parameter write on an axis, as far as its family can determine it before it is sent.
struct Stated {
    enum class Kind : std::uint8_t {
        nothing,  ///< a question, a setting, a stop, or anything else that cannot begin a motion
        motion,   ///< `move` begins
        homing,   ///< a homing begins
        unread    ///< it may begin a motion that cannot be determined here: a program, a trigger, bytes without a meaning for the family
    };
    Kind kind = Kind::unread;
    int channel = 0;    ///< the axis within the drive that it concerns; 0: the addressed axis
    Move move{};        ///< the target, speed and rates that it names, in the axis' increments
    DriveRates sets{};  ///< rates that it changes for later motions; 0: not changed
};

struct Family {
    std::string_view name;  ///< folder and catalogue name: "uim342"

    /// None of the makers is null. The catalogue must outlive the objects that they make.
    std::unique_ptr<Adapter> (*make_adapter)(const Catalogue&, LineKind);  // of the page; a drive's own catalogue is in its DriveSetup
    std::unique_ptr<Twin> (*make_twin)(const Catalogue&, const TwinSetup&);
    std::unique_ptr<Decoder> (*make_decoder)(const Catalogue&, LineKind);

    /// Empty if the address is correct in the family's form, otherwise the fault and the remedy.
    std::string (*check_address)(std::string_view address);
    /// The address of a new drive; used by `axisgate twin` without --address.
    std::string_view factory_address;
    /// For a serial line whose URI has no format: "57600 8N1". 0: the family has no serial line.
    std::uint32_t default_bit_rate;
    std::string_view default_format;
    bool uses_can;    ///< communicates by CAN frames
    bool uses_bytes;  ///< communicates over a byte line
    /// Bit rate of an embedded CAN bus if the site has none; that of a real bus is set outside.
    std::uint32_t default_can_bit_rate = 0;
    /// The addresses that a search for drives asks; nullptr: drives of this family cannot be searched for.
    ScanPlan (*scan)(const ScanWish&) = nullptr;
    /// Makes the catalogue of one drive if the site's options extend or change the family's page; nullptr: the page applies to every drive.
    /// The same input must give the same catalogue, because mappings are checked against it before the site is in force.
    OwnCatalogue (*own_catalogue)(const CatalogueWish&) = nullptr;
    /// The identifiers of the frames that drives at these addresses send, and of those sent to them. Its adapter gets only these frames
    /// (and reports of the controller), and recorded frames find their decoder by them. nullptr: every frame of the line; such a family
    /// cannot share a CAN line.
    std::vector<CanIdentifiers> (*can_identifiers)(std::span<const std::string> addresses) = nullptr;
    /// A drive of the site may name a maker's description, from which own_catalogue makes the drive's catalogue.
    bool takes_description = false;
    /// Its drives are axes of other gateways: they must be on a line `dds` (or `twin`), which they do not share with another family.
    bool uses_dds = false;
    /// The family whose adapter serves drives of this family, together with its own drives on the same line, so that resources that a line
    /// has once (the SYNC, the gateway's own node) are shared. The adapter distinguishes them by the catalogues in their DriveSetup.
    /// nullptr: its own adapter.
    const Family& (*served_by)() = nullptr;
    /// Reads a Native, an Action or a WriteParameter body for the axis of this channel. Pure; never throws; a body that it cannot read is
    /// `unread`. nullptr: native statements and actions of this family are `unread`, parameter writes are `nothing`.
    Stated (*stated)(const Catalogue&, int channel, const CommandBody&) = nullptr;
};
[[nodiscard]] inline const Family& serving_family(const Family& f) noexcept { return f.served_by ? f.served_by() : f; }

/// Every family that was found at configure time, in order of name. (Generated.)
[[nodiscard]] std::span<const Family* const> all_families();
[[nodiscard]] const Family* find_family(std::string_view name);

}  // namespace axisgate
