// A picture that is written continuously by one thread is always read as a whole by another. The result does not depend on timing: a torn
// picture would differ in its fields.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "gateway/axis/image.hpp"

namespace axisgate {
namespace {

TEST(ImageThreads, NeverTorn) {
    Image image;
    ASSERT_TRUE(image.grow(1));
    const AxisId id{0};
    std::atomic<bool> stop{false};
    std::uint64_t torn = 0;
    std::atomic<std::uint64_t> seen{0};
    std::thread reader([&] {
        while (!stop.load()) {
            const AxisPicture p = image.cell(id).read();
            seen.fetch_add(1, std::memory_order_relaxed);
            if (p.position != p.velocity || p.position_demand != p.position || static_cast<std::int64_t>(p.native_status) != p.position)
                ++torn;
        }
    });
    // Until the reader has read often enough, however late its thread begins.
    for (std::int64_t i = 0; i < 300'000 || seen.load(std::memory_order_relaxed) < 10'000; ++i) {
        auto& p = image.picture(id);
        p.position = p.velocity = p.position_demand = i;
        p.native_status = static_cast<std::uint32_t>(i);
        image.publish(id);
    }
    stop = true;
    reader.join();
    EXPECT_EQ(torn, 0u);
    EXPECT_GE(seen.load(), 10'000u);
}

}  // namespace
}  // namespace axisgate
