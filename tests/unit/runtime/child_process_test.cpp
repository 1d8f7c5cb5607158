// A child process: its output, its end, and the end of everything that it has started.
#include "gateway/runtime/child_process.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include <charconv>
#include <cstdio>

namespace axisgate {
namespace {
/// Until the process has ended; the test's own limit of time ends one that hangs.
void wait_for(ChildProcess& child) {
    while (!child.look())
        ::poll(nullptr, 0, 1);
}

TEST(ChildProcess, HasItsVariablesAndTellsOutputAndCode) {
    std::string fault;
    ChildProcess child("echo $HAND; echo to standard error >&2; exit 3", {{"HAND", "left"}}, 1000, fault);
    ASSERT_EQ(fault, "");
    wait_for(child);
    EXPECT_EQ(child.code(), 3);
    EXPECT_EQ(child.output(), "left\nto standard error\n");
}

TEST(ChildProcess, KeepsTheNewestOutput) {
    std::string fault;
    ChildProcess child("i=0; while [ $i -lt 2000 ]; do echo line $i; i=$((i+1)); done", {}, 100, fault);
    wait_for(child);
    EXPECT_EQ(child.code(), 0);
    EXPECT_LE(child.output().size(), 100u);
    EXPECT_TRUE(child.output().ends_with("line 1999\n")) << child.output();
}

TEST(ChildProcess, IsEndedWithEverythingThatItHasStarted) {
    std::string fault, output;
    {
        ChildProcess child("sleep 1000 & echo $!; wait", {}, 1000, fault);
        while (child.output().find('\n') == std::string::npos) {
            ASSERT_FALSE(child.look());
            ::poll(nullptr, 0, 1);
        }
        output = child.output();
        child.end();
        EXPECT_EQ(child.code(), 128 + SIGKILL);
    }
    pid_t grandchild = 0;
    std::from_chars(output.data(), output.data() + output.size(), grandchild);
    ASSERT_GT(grandchild, 0) << output;
    // It has gone, or is a zombie that the system has not taken away yet.
    const auto gone = [&] {
        std::FILE* file = std::fopen(fmt::format("/proc/{}/stat", grandchild).c_str(), "r");
        if (!file) return true;
        char text[256] = {};
        const std::string state(text, std::fread(text, 1, sizeof text, file));
        std::fclose(file);
        return state.find(") Z") != std::string::npos;
    };
    for (int i = 0; i < 10'000 && !gone(); ++i)
        ::poll(nullptr, 0, 1);
    EXPECT_TRUE(gone());
}

}  // namespace
}  // namespace axisgate
