// A description is put on the shelf when it is on the disk, and removed from the shelf before it is deleted on the disk.
#include "gateway/runtime/warm_descriptions.hpp"

#include "gateway/services/descriptions/description.hpp"

namespace axisgate {

void fill_shelf(StoreReader& reader, DescriptionShelf& shelf, std::string& fault) {
    auto list = reader.descriptions();
    if (!list) {
        fault = list.error().text;
        return;
    }
    for (auto& row : *list) {
        Description d{{std::move(row.name), std::move(row.text)}, std::move(row.who), row.at_unix_ns};
        d.facts = descriptions::facts(d, descriptions::read(d.text));
        shelf.put(std::move(d));
    }
}

void WarmDescriptions::add_description(Description description, std::function<void(std::string)> then) {
    threads_.on_cold([this, d = std::move(description), then = std::move(then)](Store& store) mutable {
        const auto saved = store.save_description({d.name, d.text, d.who, d.at_unix_ns});
        threads_.answer([this, d = std::move(d), then = std::move(then), fault = saved ? std::string() : saved.error().text]() mutable {
            if (fault.empty()) shelf_->put(std::move(d));
            then(fault);
        });
    });
}

void WarmDescriptions::remove_description(const std::string& name, std::function<void(std::string)> then) {
    auto kept = shelf_->find(name);
    shelf_->remove(name);
    threads_.on_cold([this, name, kept = std::move(kept), then = std::move(then)](Store& store) mutable {
        const auto gone = store.delete_description(name);
        threads_.answer([this, kept = std::move(kept), then = std::move(then), fault = gone ? std::string() : gone.error().text] {
            if (!fault.empty() && kept) shelf_->put(*kept);
            then(fault);
        });
    });
}

}  // namespace axisgate
