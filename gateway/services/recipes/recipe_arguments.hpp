// The values for "${name}" in one reading of a recipe's document; faults have their places.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// The faults of one document; at most 100 are listed.
class RecipeFaults {
public:
    explicit RecipeFaults(std::vector<SiteFault>& faults) : faults_(faults) {}
    void fault(std::string pointer, std::string text, std::string remedy);
    /// Reports members that are not in the list `known`, which has blanks around each word.
    void unknown(const boost::json::object& o, std::string_view known, const std::string& at);

protected:
    std::vector<SiteFault>& faults_;
};

class RecipeArguments : public RecipeFaults {
public:
    using RecipeFaults::RecipeFaults;
    /// `arguments` is nullptr: every parameter's default, or a value of its type.
    void read_arguments(const boost::json::object& document, const boost::json::object* arguments);
    /// The value with every "${name}" in it replaced; a text that consists only of it gets the argument's own type.
    [[nodiscard]] boost::json::value put_in(const boost::json::value& v, const std::string& at, std::size_t depth = 0);

private:
    boost::json::object values_;
};

/// RFC 6901.
[[nodiscard]] std::string pointer_token(std::string_view key);

}  // namespace axisgate
