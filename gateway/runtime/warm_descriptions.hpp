// Warm descriptions: the description port: the shelf that sites are read with, and the table of the database behind it.
// In: checked files. Out: the shelf; "it is on disk" by callbacks. Never writes by itself: the cold thread does.
#pragma once

#include <memory>

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/descriptions.hpp"

namespace axisgate {

/// What the database holds, on a shelf; `fault`: why it could not be read.
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
