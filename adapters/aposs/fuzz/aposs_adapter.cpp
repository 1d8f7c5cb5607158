// Fuzzes the adapter of MACS controllers through core/adapter.hpp, with any commands, frames, times, losses and site changes, and twins on
// the line. The invariants are in tests/fuzz/adapter_laws.hpp; in addition, each frame sent must be SYNC or a message to a node of the
// line.
#include "adapters/cia402/fuzz/can_frames.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return axisgate::cia402_drive::fuzz::run("aposs", data, size);
}
