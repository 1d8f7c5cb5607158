// Description port: the makers' files by which drives are described: what is kept, and its change.
// In: checked files. Out: the files by name; callbacks on the service thread when a change is on disk. Never looks into a text.
#pragma once

#include <functional>
#include <string>

#include "gateway/site/descriptions.hpp"

namespace axisgate {

class DescriptionPort {
public:
    virtual ~DescriptionPort() = default;
    [[nodiscard]] virtual const DescriptionShelf& descriptions() const = 0;
    /// Answers when it is on disk and sites may name it; empty: good, else what is wrong.
    virtual void add_description(Description description, std::function<void(std::string fault)> then) = 0;
    /// From now on no site may name it; if the disk refuses, it is there again. Who calls has made sure that no site does.
    virtual void remove_description(const std::string& name, std::function<void(std::string fault)> then) = 0;
};

}  // namespace axisgate
