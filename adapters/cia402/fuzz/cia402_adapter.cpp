// Fuzz: the adapter of CiA 402 drives, through core/adapter.hpp: any commands, frames, times, losses and site changes, with twins behind
// the wire. In: the fuzzer's bytes. Out: nothing; laws: tests/fuzz/adapter_laws.hpp, and that every frame sent is the SYNC, or a message to
// a node of the line.
#include "adapters/cia402/fuzz/can_frames.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return axisgate::cia402_drive::fuzz::run("cia402", data, size);
}
