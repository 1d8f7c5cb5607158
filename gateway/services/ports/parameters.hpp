// The known values of parameters: the last report of the drive, and acknowledged writes. Listeners get each value that a drive reports.
// Drives are not asked; that is a command.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gateway/core/records.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate {

struct SampleListener {
    /// A drive has reported a parameter's value, with or without a request.
    virtual void on_sample(const Sample& sample) = 0;
    virtual ~SampleListener() = default;
};

class ParameterPort {
public:
    virtual ~ParameterPort() = default;
    /// The last value that the drive has reported.
    [[nodiscard]] virtual LiveParameter live(AxisId axis, Point point) const = 0;
    /// Values written through the gateway and acknowledged, the newest per parameter.
    [[nodiscard]] virtual std::vector<StoredParameter> stored(const std::string& axis) const = 0;
    [[nodiscard]] virtual std::vector<StoredParameter> history(const std::string& axis, const std::string& parameter,
                                                               std::size_t limit) const = 0;
    virtual void listen(SampleListener* listener) = 0;
    virtual void unlisten(SampleListener* listener) = 0;
};

}  // namespace axisgate
