// Family mcode: the table of its makers, and its scan.
// In: nothing. Out: one table, by which the rest of the program reaches this folder; names in the order ! 0-9 A-Z a-z.
// Never decides anything: that is for the files beside it.
#include <algorithm>

#include "adapters/mcode/adapter.hpp"
#include "adapters/mcode/decoder.hpp"
#include "adapters/mcode/native.hpp"
#include "adapters/mcode/parameters_variables.hpp"
#include "adapters/mcode/twin/twin.hpp"

namespace axisgate {
namespace {
/// Each name of the party mode is asked for what the drive is; one that is alone on its line answers to `!`. On a line with named drives
/// `!` is left out, because they do not expect it.
ScanPlan mcode_scan(const ScanWish& wish) {
    ScanPlan plan;
    const std::string all = "!0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    const auto place = [&](const std::string& text, std::size_t otherwise) {
        if (text.empty()) return otherwise;
        const auto at = text.size() == 1 ? all.find(text) : std::string::npos;
        if (at == std::string::npos) plan.fault = text + " is no name of a drive: write ! or one of 0-9, A-Z, a-z";
        return at;
    };
    const auto from = place(wish.from, 0), to = place(wish.to, all.size() - 1);
    if (plan.fault.empty() && from > to) plan.fault = "from is behind to: the order is ! 0-9 A-Z a-z";
    if (!plan.fault.empty()) return plan;
    const bool party = std::ranges::any_of(wish.known, [](const auto& k) { return k != "!"; });
    const bool single = std::ranges::find(wish.known, "!") != wish.known.end();
    if (single) return plan;  // one drive, alone on its line: there is nobody else
    for (auto i = from; i <= to; ++i) {
        if (i != 0 || !party) plan.addresses.emplace_back(1, all[i]);
    }
    return plan;
}
}  // namespace

/// Lexium MDrive and Lexium Motion Module (MCode) on RS-422, RS-485, UART or Ethernet (port 503).
const Family& family_mcode() {
    static const Family family{
        "mcode",
        [](const Catalogue& c, LineKind) -> std::unique_ptr<Adapter> { return std::make_unique<mcode::LineAdapter>(c); },
        [](const Catalogue& c, const TwinSetup& setup) -> std::unique_ptr<Twin> { return mcode::make_twin(c, setup); },
        [](const Catalogue&, LineKind) -> std::unique_ptr<Decoder> { return std::make_unique<mcode::LineDecoder>(); },
        mcode::check_address,
        "!",   // DN of a new drive [L5002]
        9600,  // BD = 96 [L1587]
        "8N1",
        false,
        true,
        0,
        mcode_scan,
        mcode::own_catalogue,
        nullptr,
        false,
        false,
        nullptr,
        mcode::stated,
    };
    return family;
}

}  // namespace axisgate
