// The operations on the disk. They are complete or have no effect; faults are texts, and nothing throws.
#include "gateway/runtime/file_shelf.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "gateway/services/recorder/axr.hpp"
#include "gateway/store/files.hpp"

namespace axisgate {
namespace fs = std::filesystem;

std::string put_on_disk(const std::string& path, const std::string& directory, const std::string& bytes) {
    if (const auto made = files::make_directory(directory); !made) return made.error().text;
    const std::string fresh = path + ".new";
    std::string fault;
    if (const auto made = files::create(fresh, directory); !made) return made.error().text;
    {
        std::ofstream out(fresh, std::ios::binary | std::ios::trunc);
        errno = 0;
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out) fault = fmt::format("{} cannot be written: {}", path, errno != 0 ? std::strerror(errno) : "the disk is full");
    }
    if (fault.empty()) {
        if (const auto done = files::sync(fresh, directory); !done) fault = done.error().text;
    }
    if (fault.empty()) {
        if (const auto done = files::rename(fresh, path, directory); !done) fault = done.error().text;
    }
    if (!fault.empty()) delete_from_disk(fresh);
    return fault;
}

std::string rename_on_disk(const std::string& from, const std::string& to, const std::string& directory) {
    const auto done = files::rename(from, to, directory);
    return done ? std::string() : done.error().text;
}

std::optional<std::string> read_whole(const std::string& path) {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    if (!in) return std::nullopt;
    std::string bytes(static_cast<std::size_t>(std::max<std::streamoff>(0, in.tellg())), '\0');
    in.seekg(0);
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
    return bytes;
}

std::string read_beginning(const std::string& path) {
    std::string head(1u << 20, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
    return head;
}

void delete_from_disk(const std::string& path) {
    std::error_code ec;
    (void)fs::remove(path, ec);
}

std::vector<std::string> names_in(const std::string& directory, std::string_view suffix, std::size_t most) {
    std::vector<std::string> names;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(directory, ec)) {
        if (entry.path().extension() == ".new") delete_from_disk(entry.path().string());  // an interrupted write
        if (entry.path().extension() != suffix || !check_recording_name(entry.path().stem().string()).empty()) continue;
        if (names.size() < most) names.push_back(entry.path().stem().string());
    }
    return names;
}

}  // namespace axisgate
