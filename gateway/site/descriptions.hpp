// Descriptions: the manufacturers' files (EDS, DCF) that describe drives of a site, by name.
// The texts have been checked and are shared. A text never changes: its name belongs to it until it is removed. Used by one thread at a
// time: filled before the site is read, afterwards used by the service thread.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/family.hpp"

namespace axisgate {

struct Description : DescriptionText {
    std::string who;
    std::int64_t at_unix_ns = 0;
    std::shared_ptr<const boost::json::object> facts{};  ///< summary for the user; null: the file cannot be read
};

class DescriptionShelf {
public:
    using Options = std::map<std::string, std::string>;
    /// Returns nullptr if there is none.
    [[nodiscard]] std::shared_ptr<const Description> find(std::string_view name) const {
        const auto it = all_.find(name);
        return it == all_.end() ? nullptr : it->second;
    }
    /// Returns false and changes nothing if the name is in use.
    bool put(Description d) {
        std::string name = d.name;
        return all_.emplace(std::move(name), std::make_shared<const Description>(std::move(d))).second;
    }
    void remove(std::string_view name) {
        if (const auto it = all_.find(name); it != all_.end()) all_.erase(it);
    }
    [[nodiscard]] const std::map<std::string, std::shared_ptr<const Description>, std::less<>>& all() const noexcept { return all_; }
    /// What a family has made of a description for a drive with these options, while a site has it: a file of a thousand objects is read
    /// once, not with every change of the site and for every drive. nullptr: it must be made.
    [[nodiscard]] std::shared_ptr<const Catalogue> made(const Catalogue* page, const DescriptionText* of, const Options& options) const {
        for (const auto& m : made_)
            if (m.page == page && m.of.lock().get() == of && m.options == options) return m.catalogue.lock();
        return nullptr;
    }
    void keep(const Catalogue* page, const std::shared_ptr<const Description>& of, const Options& options,
              const std::shared_ptr<const Catalogue>& catalogue) {
        std::erase_if(made_, [](const Made& m) { return m.catalogue.expired() || m.of.expired(); });
        made_.push_back({page, of, options, catalogue});
    }
    /// "a.eds, b.dcf", for messages; "none" if there are none.
    [[nodiscard]] std::string names() const {
        std::string list;
        for (const auto& [name, d] : all_)
            list += (list.empty() ? "" : ", ") + name;
        return list.empty() ? "none" : list;
    }

private:
    struct Made {
        const Catalogue* page;
        std::weak_ptr<const Description> of;
        Options options;
        std::weak_ptr<const Catalogue> catalogue;
    };
    std::vector<Made> made_;
    std::map<std::string, std::shared_ptr<const Description>, std::less<>> all_;
};

}  // namespace axisgate
