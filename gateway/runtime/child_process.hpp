// A child process in a group of its own, with its output in a pipe. Bounds: the newest `most` bytes of the output are kept. Not copied;
// the destructor ends the whole group.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace axisgate {

class ChildProcess {
public:
    /// Runs `command` by /bin/sh with these variables beside those of this process. `fault` is not empty if it could not be started.
    ChildProcess(const std::string& command, const std::vector<std::pair<std::string, std::string>>& variables, std::size_t most,
                 std::string& fault);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Reads the output so far without waiting; true once the process has ended.
    [[nodiscard]] bool look();
    /// Ends the group, and waits for the process.
    void end();
    /// Empty while it runs; the exit code, or 128 and the number of the signal that has ended it, as a shell shows it.
    [[nodiscard]] std::optional<int> code() const noexcept { return code_; }
    [[nodiscard]] const std::string& output() const noexcept { return output_; }

private:
    void read();
    void wait(int options);

    std::size_t most_;
    pid_t pid_ = -1;
    int pipe_ = -1;
    std::optional<int> code_;
    std::string output_;
};

}  // namespace axisgate
