// Parts of one drive reach each other, also before all of them are constructed. A part cannot be copied, because the copy would belong to
// another drive.
#include "gateway/drive/part.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace axisgate::drive {
namespace {

struct Machine;
class Counter : public Part<Machine> {
public:
    using Part::Part;
    void count() noexcept { ++counted_; }
    [[nodiscard]] int counted() const noexcept { return counted_; }

private:
    int counted_ = 0;
};
class Button : public Part<Machine> {
public:
    using Part::Part;
    void press() noexcept;
};
struct Machine {
    Button button{*this};
    Counter counter{*this};
};
void Button::press() noexcept { drive_.counter.count(); }

TEST(Part, ReachesTheOthersOfItsOwnDriveAlone) {
    Machine one, other;
    one.button.press();
    one.button.press();
    EXPECT_EQ(one.counter.counted(), 2);
    EXPECT_EQ(other.counter.counted(), 0);
}

TEST(Part, IsNeverCopied) {
    static_assert(!std::is_copy_constructible_v<Counter> && !std::is_copy_assignable_v<Counter>);
    static_assert(!std::is_copy_constructible_v<Machine>);
}

}  // namespace
}  // namespace axisgate::drive
