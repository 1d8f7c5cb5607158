// Spare descriptor: a descriptor that a door keeps open, so that it can accept one more client when the process has no other left.
// The client is accepted in the place of the spare descriptor. Without it, a door that has used up all descriptors would lock out the
// clients of the other doors, and with them every stop that they would send.
#pragma once

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace axisgate {

class SpareDescriptor {
public:
    SpareDescriptor() { refill(); }
    ~SpareDescriptor() { release(); }
    SpareDescriptor(const SpareDescriptor&) = delete;
    SpareDescriptor& operator=(const SpareDescriptor&) = delete;

    /// Opens the spare descriptor again if one has become free; called whenever that is possible. Returns false if there is none.
    bool refill() noexcept {
        if (fd_ < 0) fd_ = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        return fd_ >= 0;
    }
    /// For an accept that found no descriptor: accepts the client in the place of the spare one. Returns -1 and errno as accept4 does, with
    /// EMFILE while the spare one is in use.
    [[nodiscard]] int accept(int listening, sockaddr* peer, socklen_t* length) noexcept {
        if (fd_ < 0) {
            errno = EMFILE;
            return -1;
        }
        release();
        const int client = ::accept4(listening, peer, length, SOCK_NONBLOCK | SOCK_CLOEXEC);
        const int why = errno;
        if (client < 0) refill();
        errno = why;
        return client;
    }
    /// Whether `error` means that the call found no descriptor, or no memory for one.
    [[nodiscard]] static constexpr bool none_left(int error) noexcept {
        return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
    }

private:
    void release() noexcept {
        if (fd_ >= 0) (void)::close(std::exchange(fd_, -1));
    }
    int fd_ = -1;
};

}  // namespace axisgate
