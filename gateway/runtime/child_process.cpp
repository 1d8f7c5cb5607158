#include "gateway/runtime/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

extern char** environ;

namespace axisgate {
namespace {
/// The environment of this process, in which `variables` replace those of the same name.
std::vector<std::string> environment(const std::vector<std::pair<std::string, std::string>>& variables) {
    std::vector<std::string> out;
    for (const auto& [name, value] : variables)
        out.push_back(name + "=" + value);
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        bool replaced = false;
        for (const auto& [name, value] : variables)
            replaced = replaced || text.starts_with(name + "=");
        if (!replaced) out.push_back(text);
    }
    return out;
}
}  // namespace

ChildProcess::ChildProcess(const std::string& command, const std::vector<std::pair<std::string, std::string>>& variables, std::size_t most,
                           std::string& fault)
    : most_(most) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        fault = std::string("no pipe for the program: ") + std::strerror(errno);
        return;
    }
    pipe_ = ends[0];
    (void)::fcntl(pipe_, F_SETFL, O_NONBLOCK);
    auto texts = environment(variables);
    std::vector<char*> entries;
    for (auto& text : texts)
        entries.push_back(text.data());
    entries.push_back(nullptr);
    std::string shell = "/bin/sh", option = "-c", words = command;
    std::array<char*, 4> arguments{shell.data(), option.data(), words.data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ends[1], 1);
    posix_spawn_file_actions_adddup2(&files, ends[1], 2);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t ordinary;  // signals that this process ignores have their effect in the program
    sigemptyset(&ordinary);
    sigaddset(&ordinary, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &ordinary);
    const int wrong = ::posix_spawn(&pid_, shell.c_str(), &files, &attributes, arguments.data(), entries.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[1]);
    if (wrong == 0) return;
    pid_ = -1;
    fault = std::string("/bin/sh cannot be started: ") + std::strerror(wrong);
}

ChildProcess::~ChildProcess() {
    end();
    if (pipe_ >= 0) ::close(pipe_);
}

void ChildProcess::read() {
    std::array<char, 4096> bytes{};
    for (;;) {
        const auto n = ::read(pipe_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;
        output_.append(bytes.data(), static_cast<std::size_t>(n));
        if (output_.size() > most_) output_.erase(0, output_.size() - most_);
    }
}

void ChildProcess::wait(int options) {
    int status = 0;
    pid_t ended = 0;
    do
        ended = ::waitpid(pid_, &status, options);
    while (ended < 0 && errno == EINTR);
    if (ended != pid_) return;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool ChildProcess::look() {
    if (pid_ < 0 || code_) return true;
    wait(WNOHANG);
    read();
    return code_.has_value();
}

void ChildProcess::end() {
    if (pid_ < 0) return;
    (void)::kill(-pid_, SIGKILL);  // descendants that the program has left behind, too
    if (!code_) wait(0);
    read();
    pid_ = -1;
}

}  // namespace axisgate
