// Makes the map of a profile by its language. The CiA 402 block is made elsewhere: it is a part of the standard map (cia402_block.hpp).
#include "gateway/registers/profiles/lexium.hpp"
#include "gateway/registers/profiles/linmot.hpp"
#include "gateway/registers/profiles/pacontrol.hpp"

namespace axisgate::registers {

std::unique_ptr<ProfileMap> make_profile(ProfileLanguage language, const DoorPort& port, ProfileMap::Setup setup) {
    switch (language) {
        case ProfileLanguage::lexium:
            return std::make_unique<LexiumMap>(port, std::move(setup));
        case ProfileLanguage::pacontrol:
            return std::make_unique<PaControlMap>(port, std::move(setup));
        case ProfileLanguage::linmot:
            return std::make_unique<LinMotMap>(port, std::move(setup));
        case ProfileLanguage::cia402:
            break;
    }
    return nullptr;
}

}  // namespace axisgate::registers
