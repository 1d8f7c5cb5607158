// Histogram: buckets, quantiles, and the text that Prometheus reads.
#include <gtest/gtest.h>

#include <thread>

#include "gateway/core/histogram.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

TEST(Histogram, WhatLiesOnABoundIsWithinItsBucket) {
    for (std::size_t i = 0; i < Histogram::bounds.size(); ++i) {
        Histogram h;
        h.observe(Duration{Histogram::bounds[i]});
        h.observe(Duration{Histogram::bounds[i] + 1}, 3);
        const auto r = h.read();
        EXPECT_EQ(r.buckets[i], 1u) << i;
        EXPECT_EQ(r.buckets[i + 1], 3u) << i;
        EXPECT_EQ(r.sum_ns, static_cast<std::uint64_t>(4 * Histogram::bounds[i] + 3));
    }
    Histogram h;
    h.observe(-5s);
    EXPECT_EQ(h.read().buckets[0], 1u);
    EXPECT_EQ(h.read().sum_ns, 0u) << "a sum never goes back";
}

TEST(Histogram, QuantilesLieWithinTheirBucket) {
    Histogram h;
    EXPECT_EQ(h.read().quantile(0.999), 0);
    h.observe(15us, 999);
    h.observe(3ms);
    EXPECT_NEAR(h.read().quantile(0.5), 15e-6, 1e-6);
    EXPECT_NEAR(h.read().quantile(0.999), 20e-6, 1e-7);
    EXPECT_NEAR(h.read().quantile(1), 5e-3, 1e-6);
    h.observe(20s, 1000);
    EXPECT_EQ(h.read().quantile(1), 10) << "more than that is not known";
}

TEST(Histogram, TheTextIsCumulativeAndCarriesItsLabels) {
    Histogram h;
    h.observe(1500ns);
    h.observe(300us, 2);
    h.observe(11s);
    const std::string text = metric_head("x_seconds", "histogram", "What it is.") + metric_lines("x_seconds", h.read(), "door=\"modbus\"");
    for (const auto* line : {"# HELP x_seconds What it is.\n# TYPE x_seconds histogram\n",
                             "x_seconds_bucket{door=\"modbus\",le=\"1e-06\"} 0\n", "x_seconds_bucket{door=\"modbus\",le=\"2e-06\"} 1\n",
                             "x_seconds_bucket{door=\"modbus\",le=\"0.0002\"} 1\n", "x_seconds_bucket{door=\"modbus\",le=\"0.0005\"} 3\n",
                             "x_seconds_bucket{door=\"modbus\",le=\"10\"} 3\n", "x_seconds_bucket{door=\"modbus\",le=\"+Inf\"} 4\n",
                             "x_seconds_sum{door=\"modbus\"} 11.000601500\n", "x_seconds_count{door=\"modbus\"} 4\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
    EXPECT_NE(metric_lines("y", h.read()).find("y_bucket{le=\"1e-06\"} 0\n"), std::string::npos);
    EXPECT_NE(metric_lines("y", h.read()).find("y_sum 11.0006015"), std::string::npos);
}

TEST(Histogram, OneThreadCountsWhileAnotherReads) {
    Histogram h;
    std::thread writer([&h] {
        for (int i = 0; i < 100'000; ++i)
            h.observe(Duration{i});
    });
    std::uint64_t before = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t now = h.read().count();
        EXPECT_GE(now, before);
        before = now;
    }
    writer.join();
    EXPECT_EQ(h.read().count(), 100'000u);
}

}  // namespace
}  // namespace axisgate
