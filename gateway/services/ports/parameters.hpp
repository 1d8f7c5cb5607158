// Parameter port: what is known of parameters without asking a drive: the value that it reported last, and what was written and
// acknowledged. In: axes, points. Out: values with their age; who listens is told of each value that a drive reports. Never asks a drive:
// that is a command.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gateway/core/records.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate {

struct SampleListener {
    /// A drive has reported a parameter's value, asked for or not.
    virtual void on_sample(const Sample& sample) = 0;
    virtual ~SampleListener() = default;
};

class ParameterPort {
public:
    virtual ~ParameterPort() = default;
    /// Last value that the drive reported, asked for or not.
    [[nodiscard]] virtual LiveParameter live(AxisId axis, Point point) const = 0;
    /// Values written through the gateway and acknowledged, newest per parameter.
    [[nodiscard]] virtual std::vector<StoredParameter> stored(const std::string& axis) const = 0;
    [[nodiscard]] virtual std::vector<StoredParameter> history(const std::string& axis, const std::string& parameter,
                                                               std::size_t limit) const = 0;
    virtual void listen(SampleListener* listener) = 0;
    virtual void unlisten(SampleListener* listener) = 0;
};

}  // namespace axisgate
