// Fuzz: what all targets share: the input taken apart, and a check that stops the program with a sentence when a law is broken.
// In: the fuzzer's bytes. Out: numbers, texts, frames. Never takes randomness from elsewhere: an input is its own replay.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/site/site.hpp"

namespace axisgate::fuzz {

/// Stops the program with the law's sentence unless it holds.
void require(bool holds, const char* law);
/// Every family that was built in, with its catalogue; read once.
const Families& families();
/// A frame of any kind with anything in it.
Frame any_frame(FuzzedDataProvider& in);
/// Any value that a client or a memory file can give.
Value any_value(FuzzedDataProvider& in);
/// A step of time: mostly what a line sees, sometimes hours.
Duration any_step(FuzzedDataProvider& in);

}  // namespace axisgate::fuzz
