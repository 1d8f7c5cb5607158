// Family mcode: the table of its makers.
// In: nothing. Out: one table, by which the rest of the program reaches this folder.
// Never decides anything: that is for the files beside it.
#include "adapters/mcode/family.hpp"

#include "adapters/mcode/adapter.hpp"
#include "adapters/mcode/decoder.hpp"
#include "adapters/mcode/parameters_variables.hpp"
#include "adapters/mcode/twin/twin.hpp"

namespace axisgate {

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
        mcode::scan,
        mcode::own_catalogue,
    };
    return family;
}

}  // namespace axisgate
