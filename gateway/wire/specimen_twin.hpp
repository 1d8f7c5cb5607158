// The freedoms that are the same for all families, around any twin: the time and order of its answers, the form in which bytes arrive, its
// boot, its silence while it writes its memory, and noise. The wrapped twin does not know of them.
#pragma once

#include <memory>

#include "gateway/core/family.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate {

/// Names of common freedoms, which a family's page lists if they apply to its drives; 0 switches each one off.
namespace common_freedom {
inline constexpr std::string_view reply_ms = "reply_ms";                ///< an answer is sent this long after its request
inline constexpr std::string_view reply_spread_ms = "reply_spread_ms";  ///< and up to this much later, differently each time
inline constexpr std::string_view late_per_mille = "late_per_mille";    ///< of the answers, this share comes `late_ms` later
inline constexpr std::string_view late_ms = "late_ms";
inline constexpr std::string_view doubled_per_mille = "doubled_per_mille";  ///< of the answers, this share is sent twice
inline constexpr std::string_view lost_per_mille = "lost_per_mille";        ///< of the answers, this share is not sent
inline constexpr std::string_view chunk_bytes = "chunk_bytes";              ///< bytes are sent in runs of at most this many,
inline constexpr std::string_view chunk_pause_ms = "chunk_pause_ms";        ///< with this pause between two runs of one message
inline constexpr std::string_view noise_per_mille = "noise_per_mille";      ///< before this share of the messages a wrong byte is sent
inline constexpr std::string_view boot_ms = "boot_ms";                      ///< it hears and says nothing this long after power-on
inline constexpr std::string_view flash_silence_ms =
    "flash_silence_ms";  ///< no frame is sent this long after a request that changed its memory
}  // namespace common_freedom

/// Fills setup.freedoms and setup.seed for the specimen that `setup.options` name ("specimen", and freedoms by name); the seed also depends
/// on the address. `page` is the catalogue whose freedoms apply (the family's page or the drive's own).
void specimen_setup(const Catalogue& page, TwinSetup& setup);
/// The twin of a drive as the specimen that `setup.options` name: specimen_setup, and the common freedoms around it.
[[nodiscard]] std::unique_ptr<Twin> make_specimen(const Family& family, const Catalogue& page, TwinSetup setup);
/// `twin` with the common freedoms of `setup`; itself if all of them are off.
[[nodiscard]] std::unique_ptr<Twin> with_common_freedoms(std::unique_ptr<Twin> twin, const TwinSetup& setup);

}  // namespace axisgate
