// The common parts of all targets: the input split into values, and a check that aborts the program with a text when a law is broken. All
// randomness comes from the input, so that it can be replayed.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/frame.hpp"
#include "gateway/site/site.hpp"

namespace axisgate::fuzz {

/// Aborts the program with the law's text unless it holds.
void require(bool holds, const char* law);
/// Every embedded family with its catalogue; read once.
const Families& families();
/// A frame of any kind with any content.
Frame any_frame(FuzzedDataProvider& in);
/// Any value that a client or a memory file can contain.
Value any_value(FuzzedDataProvider& in);
/// A step of time: mostly typical ones of a line, sometimes hours.
Duration any_step(FuzzedDataProvider& in);

}  // namespace axisgate::fuzz
