// SQLite's file layer interface, passed on to the real one, with the requested failures. Nothing is buffered: calls that do not fail reach
// the real file at once.
#include "tests/unit/store/fault_vfs.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>

namespace axisgate::test {
namespace {

struct File {
    sqlite3_file head;  // the part that SQLite sees
    FaultVfs* owner;
    std::string* path;
    sqlite3_file* real;  // follows this struct in memory
};
File& file_of(sqlite3_file* f) { return *reinterpret_cast<File*>(f); }
FaultVfs& owner_of(sqlite3_vfs* v) { return *static_cast<FaultVfs*>(v->pAppData); }
sqlite3_vfs* base_of(sqlite3_vfs* v) { return owner_of(v).base; }

int close_file(sqlite3_file* f) {
    File& file = file_of(f);
    const int rc = file.real->pMethods != nullptr ? file.real->pMethods->xClose(file.real) : SQLITE_OK;
    delete file.path;
    return rc;
}
int read_bytes(sqlite3_file* f, void* to, int n, sqlite3_int64 at) {
    if (const int rc = file_of(f).owner->verdict(FaultVfs::read); rc != SQLITE_OK) return rc;
    return file_of(f).real->pMethods->xRead(file_of(f).real, to, n, at);
}
int write_bytes(sqlite3_file* f, const void* from, int n, sqlite3_int64 at) {
    File& file = file_of(f);
    if (const int rc = file.owner->verdict(FaultVfs::write); rc != SQLITE_OK) {
        // A full disk writes the part that still fits: half of it, so that later code must not trust the length.
        const int half = n / 2;
        if (half > 0 && file.real->pMethods->xWrite(file.real, from, half, at) == SQLITE_OK) {
            file.owner->wrote(*file.path, {at, std::string(static_cast<const char*>(from), static_cast<std::size_t>(half)), -1});
        }
        return rc;
    }
    const int rc = file.real->pMethods->xWrite(file.real, from, n, at);
    if (rc == SQLITE_OK) file.owner->wrote(*file.path, {at, std::string(static_cast<const char*>(from), static_cast<std::size_t>(n)), -1});
    return rc;
}
int truncate_file(sqlite3_file* f, sqlite3_int64 to) {
    File& file = file_of(f);
    if (const int rc = file.owner->verdict(FaultVfs::truncate); rc != SQLITE_OK) return rc;
    const int rc = file.real->pMethods->xTruncate(file.real, to);
    if (rc == SQLITE_OK) file.owner->wrote(*file.path, {0, {}, to});
    return rc;
}
int sync_file(sqlite3_file* f, int flags) {
    File& file = file_of(f);
    if (const int rc = file.owner->verdict(FaultVfs::sync); rc != SQLITE_OK) return rc;
    // Not passed on: no power is really cut, and the tests are faster.
    static_cast<void>(flags);
    file.owner->synced(*file.path);
    return SQLITE_OK;
}
int file_size(sqlite3_file* f, sqlite3_int64* n) {
    if (const int rc = file_of(f).owner->verdict(FaultVfs::size); rc != SQLITE_OK) return rc;
    return file_of(f).real->pMethods->xFileSize(file_of(f).real, n);
}
int lock(sqlite3_file* f, int level) { return file_of(f).real->pMethods->xLock(file_of(f).real, level); }
int unlock(sqlite3_file* f, int level) { return file_of(f).real->pMethods->xUnlock(file_of(f).real, level); }
int check_reserved(sqlite3_file* f, int* out) { return file_of(f).real->pMethods->xCheckReservedLock(file_of(f).real, out); }
int control(sqlite3_file* f, int op, void* arg) { return file_of(f).real->pMethods->xFileControl(file_of(f).real, op, arg); }
int sector_size(sqlite3_file* f) { return file_of(f).real->pMethods->xSectorSize(file_of(f).real); }
// No guarantees about power cuts: the tests assume the worst disk.
int characteristics(sqlite3_file*) { return 0; }
int shm_map(sqlite3_file* f, int page, int size, int extend, void volatile** out) {
    if (const int rc = file_of(f).owner->verdict(FaultVfs::shared_memory); rc != SQLITE_OK) return rc;
    return file_of(f).real->pMethods->xShmMap(file_of(f).real, page, size, extend, out);
}
int shm_lock(sqlite3_file* f, int offset, int n, int flags) {
    return file_of(f).real->pMethods->xShmLock(file_of(f).real, offset, n, flags);
}
void shm_barrier(sqlite3_file* f) { file_of(f).real->pMethods->xShmBarrier(file_of(f).real); }
int shm_unmap(sqlite3_file* f, int remove) { return file_of(f).real->pMethods->xShmUnmap(file_of(f).real, remove); }

const sqlite3_io_methods methods = {2,        close_file,  read_bytes,     write_bytes, truncate_file, sync_file,       file_size,
                                    lock,     unlock,      check_reserved, control,     sector_size,   characteristics, shm_map,
                                    shm_lock, shm_barrier, shm_unmap,      nullptr,     nullptr};

int open_file(sqlite3_vfs* v, const char* path, sqlite3_file* f, int flags, int* out_flags) {
    File& file = file_of(f);
    file.head.pMethods = nullptr;
    file.owner = &owner_of(v);
    file.real = reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(f) + sizeof(File));
    if (const int rc = file.owner->verdict(FaultVfs::open); rc != SQLITE_OK) return rc;
    if (file.owner->is_read_only() && (flags & SQLITE_OPEN_READWRITE) != 0) {
        flags = (flags & ~(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE)) | SQLITE_OPEN_READONLY;
    }
    int granted = 0;
    const int rc = base_of(v)->xOpen(base_of(v), path, file.real, flags, &granted);
    if (out_flags != nullptr) *out_flags = granted;
    if (rc != SQLITE_OK) return rc;
    file.path = new std::string(path == nullptr ? "" : path);
    file.head.pMethods = &methods;
    return SQLITE_OK;
}
int delete_file(sqlite3_vfs* v, const char* path, int sync) {
    const int rc = base_of(v)->xDelete(base_of(v), path, sync);
    if (rc == SQLITE_OK) owner_of(v).removed(path);
    return rc;
}
int access_file(sqlite3_vfs* v, const char* path, int flags, int* out) { return base_of(v)->xAccess(base_of(v), path, flags, out); }
int full_path(sqlite3_vfs* v, const char* path, int n, char* out) { return base_of(v)->xFullPathname(base_of(v), path, n, out); }
int randomness(sqlite3_vfs* v, int n, char* out) { return base_of(v)->xRandomness(base_of(v), n, out); }
int pause(sqlite3_vfs*, int) { return 0; }  // no test waits for a lock
int current_time(sqlite3_vfs* v, double* out) { return base_of(v)->xCurrentTime(base_of(v), out); }
int current_time_64(sqlite3_vfs* v, sqlite3_int64* out) { return base_of(v)->xCurrentTimeInt64(base_of(v), out); }
int last_error(sqlite3_vfs* v, int, char*) { return owner_of(v).last_system(); }

std::string content(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

FaultVfs::FaultVfs() {
    static int count = 0;
    name_ = "axisgate-fault-" + std::to_string(++count);
    base = sqlite3_vfs_find(nullptr);
    vfs_.iVersion = 2;
    vfs_.szOsFile = static_cast<int>(sizeof(File)) + base->szOsFile;
    vfs_.mxPathname = base->mxPathname;
    vfs_.zName = name_.c_str();
    vfs_.pAppData = this;
    vfs_.xOpen = open_file;
    vfs_.xDelete = delete_file;
    vfs_.xAccess = access_file;
    vfs_.xFullPathname = full_path;
    vfs_.xRandomness = randomness;
    vfs_.xSleep = pause;
    vfs_.xCurrentTime = current_time;
    vfs_.xCurrentTimeInt64 = current_time_64;
    vfs_.xGetLastError = last_error;
    sqlite3_vfs_register(&vfs_, 0);
}

FaultVfs::~FaultVfs() { sqlite3_vfs_unregister(&vfs_); }

void FaultVfs::fail(unsigned operations, int code, int system, std::uint64_t after, std::uint64_t times) {
    operations_ = operations;
    code_ = code;
    system_ = system;
    after_ = after;
    times_ = times;
    calls_ = 0;
    failures_ = 0;
}

void FaultVfs::heal() { operations_ = 0; }

int FaultVfs::verdict(Operation operation) {
    if ((operations_ & operation) == 0) return SQLITE_OK;
    const std::uint64_t call = calls_++;
    if (call < after_ || call - after_ >= times_) return SQLITE_OK;
    ++failures_;
    errno = system_;  // as a real call would leave it
    return code_;
}

void FaultVfs::remember(const std::string& directory) {
    disk_.clear();
    for (const auto& e : std::filesystem::directory_iterator(directory)) {
        const std::string path = e.path().string();
        if (!path.ends_with("-shm") && !path.ends_with(".lock")) disk_[path].synced = content(path);
    }
    remembering_ = true;
}

void FaultVfs::wrote(const std::string& file, Pending what) {
    if (remembering_ && !file.empty()) disk_[file].pending.push_back(std::move(what));
}

void FaultVfs::synced(const std::string& file) {
    if (!remembering_ || file.empty()) return;
    disk_[file] = {content(file), {}};
}

void FaultVfs::removed(const std::string& file) { disk_.erase(file); }

void FaultVfs::power_cut(const std::string& to, std::mt19937& random) const {
    // Disks differ: one has written everything, one nothing without reporting it, most have written some of it.
    const auto manner = random() % 4;
    for (const auto& [path, disk] : disk_) {
        std::string image = disk.synced;
        for (const Pending& p : disk.pending) {
            const auto fate = manner < 2 ? manner : random() % 3;  // 0 lost, 1 whole, 2 torn
            if (fate == 0) continue;
            if (p.truncate_to >= 0) {
                image.resize(static_cast<std::size_t>(p.truncate_to));
                continue;
            }
            std::size_t n = p.bytes.size();
            if (fate == 2) n = std::min(n, random() % (n / 512 + 1) * 512);
            const auto at = static_cast<std::size_t>(p.at);
            if (n > 0 && image.size() < at + n) image.resize(at + n);
            image.replace(at < image.size() ? at : image.size(), n, p.bytes, 0, n);
        }
        std::ofstream out(std::filesystem::path(to) / std::filesystem::path(path).filename(), std::ios::binary);
        out << image;
    }
}

}  // namespace axisgate::test
