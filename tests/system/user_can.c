/* A CAN bus without a kernel that has one: a library for LD_PRELOAD. A raw CAN socket becomes a packet socket to the bus of user_can.py,
 * which is named by AXISGATE_USER_CAN; the bus gives each frame to all others and, as the kernel does, back to its sender with MSG_CONFIRM.
 * The interface is one that exists on each computer: can:lo. Other sockets are not touched. A process can have 64 such sockets.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <linux/can.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { most_sockets = 64 };
static int ours[most_sockets]; /* descriptors plus 1; 0: free */

static int* place_of(int fd) {
    for (int i = 0; i < most_sockets; ++i)
        if (ours[i] == fd + 1) return &ours[i];
    return NULL;
}

int socket(int domain, int type, int protocol) {
    int (*real)(int, int, int) = (int (*)(int, int, int))dlsym(RTLD_NEXT, "socket");
    if (domain != PF_CAN) return real(domain, type, protocol);
    const int fd = real(AF_UNIX, SOCK_SEQPACKET | (type & (SOCK_NONBLOCK | SOCK_CLOEXEC)), 0);
    int* place = fd < 0 ? NULL : place_of(-1);
    if (place != NULL) *place = fd + 1;
    return fd;
}

int bind(int fd, const struct sockaddr* address, socklen_t size) {
    int (*real)(int, const struct sockaddr*, socklen_t) = (int (*)(int, const struct sockaddr*, socklen_t))dlsym(RTLD_NEXT, "bind");
    if (address->sa_family != AF_CAN || place_of(fd) == NULL) return real(fd, address, size);
    struct sockaddr_un bus = {.sun_family = AF_UNIX};
    const char* path = getenv("AXISGATE_USER_CAN");
    if (path == NULL || strlen(path) >= sizeof bus.sun_path) {
        errno = ENODEV;
        return -1;
    }
    strcpy(bus.sun_path, path);
    return connect(fd, (const struct sockaddr*)&bus, sizeof bus);
}

int setsockopt(int fd, int level, int name, const void* value, socklen_t size) {
    int (*real)(int, int, int, const void*, socklen_t) = (int (*)(int, int, int, const void*, socklen_t))dlsym(RTLD_NEXT, "setsockopt");
    return place_of(fd) != NULL ? 0 : real(fd, level, name, value, size);
}

int recvmmsg(int fd, struct mmsghdr* messages, unsigned count, int flags, struct timespec* timeout) {
    int (*real)(int, struct mmsghdr*, unsigned, int, struct timespec*) =
        (int (*)(int, struct mmsghdr*, unsigned, int, struct timespec*))dlsym(RTLD_NEXT, "recvmmsg");
    const int n = real(fd, messages, count, flags, timeout);
    if (place_of(fd) == NULL) return n;
    for (int i = 0; i < n; ++i) {
        struct can_frame* frame = messages[i].msg_hdr.msg_iov[0].iov_base;
        if (messages[i].msg_len == 0) { /* the bus is gone */
            errno = ENETDOWN;
            return i == 0 ? -1 : i;
        }
        if (frame->__res0 != 0) messages[i].msg_hdr.msg_flags |= MSG_CONFIRM;
        frame->__res0 = 0;
    }
    return n;
}

int close(int fd) {
    int (*real)(int) = (int (*)(int))dlsym(RTLD_NEXT, "close");
    int* place = fd < 0 ? NULL : place_of(fd);
    if (place != NULL) *place = 0;
    return real(fd);
}
