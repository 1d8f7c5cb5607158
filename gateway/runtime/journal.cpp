// The socket of systemd's journal in its own protocol: values with line ends are preceded by their length. A message is cut at 64 KiB.
#include "gateway/runtime/journal.hpp"

#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace axisgate {
namespace {
constexpr std::size_t longest_value = 32u << 10;

void put_field(std::string& s, std::string_view name, std::string_view value) {
    value = value.substr(0, longest_value);
    s += name;
    if (value.find('\n') == std::string_view::npos) {
        s += '=';
    } else {
        s += '\n';
        for (unsigned byte = 0; byte < 8; ++byte)
            s += static_cast<char>(std::uint64_t{value.size()} >> 8 * byte & 0xFF);
    }
    s += value;
    s += '\n';
}
}  // namespace

bool Journal::is_standard_error() noexcept {
    const char* stream = std::getenv("JOURNAL_STREAM");
    struct stat what {};
    if (!stream || ::fstat(STDERR_FILENO, &what) != 0) return false;
    char* end = nullptr;
    const auto device = std::strtoull(stream, &end, 10);
    if (end == stream || *end != ':') return false;
    const auto inode = std::strtoull(end + 1, nullptr, 10);
    return device == what.st_dev && inode == what.st_ino;
}

Journal::Journal(const std::string& socket_path) {
    sockaddr_un address{};
    if (socket_path.size() >= sizeof address.sun_path) return;
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, socket_path.data(), socket_path.size());
    fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd_ >= 0 && ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        ::close(fd_);
        fd_ = -1;
    }
}

Journal::~Journal() {
    if (fd_ >= 0) ::close(fd_);
}

bool Journal::send(int priority, std::string_view message, std::span<const Field> fields) const {
    if (fd_ < 0) return false;
    std::string s;
    put_field(s, "MESSAGE", message);
    put_field(s, "PRIORITY", fmt::format("{}", priority));
    put_field(s, "SYSLOG_IDENTIFIER", "axisgate");
    for (const auto& [name, value] : fields) {
        if (!value.empty()) put_field(s, name, value);
    }
    return ::send(fd_, s.data(), s.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(s.size());
}

}  // namespace axisgate
