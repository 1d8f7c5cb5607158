// A folder of named files of one kind with their properties: scanned at the start; written, read, renamed and deleted on the disk's own
// thread, with answers on the service thread. An existing file is never overwritten, and no incomplete file is left. Bounded by `most`
// files; the caller limits the bytes.
#pragma once

#include <fmt/format.h>
#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/recorder.hpp"
#include "gateway/services/recorder/axr.hpp"

namespace axisgate {

/// Empty, or the reason why it is not on the disk; then no part of it is.
[[nodiscard]] std::string put_on_disk(const std::string& path, const std::string& directory, const std::string& bytes);
[[nodiscard]] std::string rename_on_disk(const std::string& from, const std::string& to, const std::string& directory);
[[nodiscard]] std::optional<std::string> read_whole(const std::string& path);
/// The first megabyte.
[[nodiscard]] std::string read_beginning(const std::string& path);
void delete_from_disk(const std::string& path);
/// Names of the files with this suffix, without it; interrupted writes are deleted.
[[nodiscard]] std::vector<std::string> names_in(const std::string& directory, std::string_view suffix, std::size_t most);

/// `Info` has `name`, `bytes`, `at_unix_ns` and `fault`.
template <class Info>
class FileShelf {
public:
    using Then = std::function<void(RecordingFault)>;
    static constexpr std::size_t most = 100;

    /// `kind` is the name of one file, such as "recording".
    FileShelf(const WarmThreads& threads, boost::asio::thread_pool& disk, std::string kind, std::string suffix)
        : threads_(threads), disk_(disk), kind_(std::move(kind)), suffix_(std::move(suffix)) {}

    /// The properties that are known at once come from the beginning of each file. Then each file is read completely, one after the other,
    /// and damage is reported.
    void open(std::string directory, const std::function<Info(const std::string& path, std::string name)>& look) {
        directory_ = std::move(directory);
        for (auto& name : names_in(directory_, suffix_, most)) {
            Info info = look(path_of(name), name);
            kept_[name] = std::move(info);
        }
        check_after({});
    }
    [[nodiscard]] const std::map<std::string, Info>& kept() const noexcept { return kept_; }
    [[nodiscard]] std::vector<Info> newest_first() const {
        std::vector<Info> out;
        for (const auto& [name, info] : kept_)
            out.push_back(info);
        std::ranges::sort(out, [](const Info& a, const Info& b) { return a.at_unix_ns > b.at_unix_ns; });
        return out;
    }
    [[nodiscard]] std::uint64_t bytes() const {
        std::uint64_t n = 0;
        for (const auto& [name, info] : kept_)
            n += info.bytes;
        return n;
    }
    [[nodiscard]] bool full(std::uint64_t bound) const { return kept_.size() >= most || bytes() >= bound; }
    [[nodiscard]] const std::string& disk_fault() const noexcept { return disk_fault_; }
    [[nodiscard]] bool writing() const noexcept { return writing_; }
    [[nodiscard]] RecordingFault exists(const std::string& name) const {
        return {RecordingFault::Kind::exists, fmt::format("there is a {} {} already: choose another name", kind_, name)};
    }

    /// `content` is called on the disk's thread. One at a time.
    void write(Info info, std::function<std::string()> content, std::function<void(RecordingFault, Info)> then) {
        writing_ = true;
        const std::string path = path_of(info.name);
        boost::asio::post(disk_, [this, info = std::move(info), path, directory = directory_, content = std::move(content),
                                  then = std::move(then)]() mutable {
            const std::string bytes = content();
            info.bytes = bytes.size();
            auto fault = put_on_disk(path, directory, bytes);
            threads_.answer([this, info = std::move(info), fault = std::move(fault), then = std::move(then)]() mutable {
                writing_ = false;
                disk_fault_ = fault;
                if (!fault.empty())
                    return then({RecordingFault::Kind::no_room, fmt::format("the {} is not written: {}", kind_, fault)}, std::move(info));
                kept_[info.name] = info;
                then({}, std::move(info));
            });
        });
    }
    void load(const std::string& name, std::function<void(std::optional<std::string>)> then) {
        read<std::string>(
            name, [](std::string&& bytes) { return std::move(bytes); }, std::move(then));
    }
    /// The result of `make` from its bytes, on the disk's thread; empty if the file does not exist.
    template <class T, class Make>
    void read(const std::string& name, Make make, std::function<void(std::optional<T>)> then) {
        if (!kept_.contains(name)) return then(std::nullopt);
        boost::asio::post(disk_, [this, path = path_of(name), make = std::move(make), then = std::move(then)]() mutable {
            std::optional<T> made;
            if (auto bytes = read_whole(path)) made.emplace(make(std::move(*bytes)));
            threads_.answer([then = std::move(then), made = std::move(made)]() mutable { then(std::move(made)); });
        });
    }
    /// `change` updates the properties of a renamed file.
    void rename(const std::string& name, const std::string& to, const std::function<void(Info&)>& change, Then then) {
        if (!kept_.contains(name)) return then({RecordingFault::Kind::no_such, ""});
        if (name == to) return then({});
        if (kept_.contains(to)) return then(exists(to));
        move(name, to);
        change(kept_[to]);
        boost::asio::post(
            disk_, [this, from = path_of(name), into = path_of(to), directory = directory_, name, to, then = std::move(then)]() mutable {
                threads_.answer([this, name, to, fault = rename_on_disk(from, into, directory), then = std::move(then)] {
                    if (fault.empty()) return then({});
                    if (kept_.contains(to)) move(to, name);
                    then({RecordingFault::Kind::no_room, fault});
                });
            });
    }
    void remove(const std::string& name, Then then) {
        if (kept_.erase(name) == 0) return then({RecordingFault::Kind::no_such, ""});
        boost::asio::post(disk_, [this, path = path_of(name), then = std::move(then)]() mutable {
            delete_from_disk(path);
            threads_.answer([then = std::move(then)] { then({}); });
        });
    }

private:
    void check_after(const std::string& last) {
        auto next = last.empty() ? kept_.begin() : kept_.upper_bound(last);
        while (next != kept_.end() && !next->second.fault.empty())
            ++next;
        if (next == kept_.end()) return;
        read<std::string>(
            next->first, [](const std::string& bytes) { return read_axr(bytes).fault; },
            [this, name = next->first](const std::optional<std::string>& fault) {
                const auto it = kept_.find(name);
                if (const std::string text = fault.value_or("the file cannot be read"); it != kept_.end() && !text.empty()) {
                    const Info whole = std::exchange(it->second, Info());
                    it->second.name = name, it->second.bytes = whole.bytes, it->second.fault = text;
                }
                check_after(name);
            });
    }
    [[nodiscard]] std::string path_of(const std::string& name) const { return directory_ + "/" + name + suffix_; }
    void move(const std::string& name, const std::string& to) {
        auto node = kept_.extract(name);
        node.key() = node.mapped().name = to;
        kept_.insert(std::move(node));
    }

    const WarmThreads& threads_;
    boost::asio::thread_pool& disk_;
    std::string kind_, suffix_, directory_, disk_fault_;
    std::map<std::string, Info> kept_;
    bool writing_ = false;
};

}  // namespace axisgate
