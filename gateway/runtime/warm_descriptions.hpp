// The description port: the shelf from which sites are read, and the table of the database behind it, which the storage thread writes.
#pragma once

#include <memory>

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/descriptions.hpp"

namespace axisgate {

/// Puts the descriptions of the database on a shelf; `fault` is the reason if they could not be read.
void fill_shelf(StoreReader& reader, DescriptionShelf& shelf, std::string& fault);

class WarmDescriptions final : public DescriptionPort {
public:
    WarmDescriptions(const WarmThreads& threads, std::shared_ptr<DescriptionShelf> shelf)
        : threads_(threads), shelf_(shelf ? std::move(shelf) : std::make_shared<DescriptionShelf>()) {}
    [[nodiscard]] const DescriptionShelf& descriptions() const override { return *shelf_; }
    void add_description(Description description, std::function<void(std::string)> then) override;
    void remove_description(const std::string& name, std::function<void(std::string)> then) override;

private:
    const WarmThreads& threads_;
    std::shared_ptr<DescriptionShelf> shelf_;
};

}  // namespace axisgate
