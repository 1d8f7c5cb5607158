// Spare descriptor: one descriptor that a door keeps open for the moment when the process has no other, so that it can still take a client.
// In: a listening socket. Out: an accepted client in the spare one's place. Without it, one door that has taken all descriptors shuts the
// others, and with them every stop that would come over them.
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

    /// Has it again, if a descriptor has become free; called whenever one may have. False: none has.
    bool refill() noexcept {
        if (fd_ < 0) fd_ = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        return fd_ >= 0;
    }
    /// After an accept that found no descriptor: takes the client in the place of the spare one. -1 and errno as accept4 does it, which is
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
    /// What a call says that found no descriptor, or no memory for one.
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
