// The makers' files by which drives are described. Callbacks come on the service thread when a change is on the disk. The texts are not
// interpreted here.
#pragma once

#include <functional>
#include <string>

#include "gateway/site/descriptions.hpp"

namespace axisgate {

class DescriptionPort {
public:
    virtual ~DescriptionPort() = default;
    [[nodiscard]] virtual const DescriptionShelf& descriptions() const = 0;
    /// Answers when the file is on the disk and sites may name it; empty if good, otherwise the fault.
    virtual void add_description(Description description, std::function<void(std::string fault)> then) = 0;
    /// From now on no site may name it; if the disk refuses, it is restored. The caller has checked that no site names it.
    virtual void remove_description(const std::string& name, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
