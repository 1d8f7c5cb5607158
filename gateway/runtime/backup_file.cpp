// The contents list comes first, so that a newer form is recognized at once; the checksums come last, in the form of sha256sum, so that
// people can unpack and check a backup without this program. Only sizes that the contents list names are read.
#include "gateway/runtime/backup_file.hpp"

#include <fmt/core.h>
#include <sodium.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "gateway/core/text.hpp"
#include "gateway/runtime/sealed.hpp"
#include "gateway/runtime/tar.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
using Kind = BackupFault::Kind;
constexpr std::string_view contents_member = "backup.json", sums_member = "backup.sha256";
constexpr std::string_view contents_kind = "axisgate backup";
constexpr std::uint64_t most_contents = 65536, most_small = 1U << 20, most_database = StoreLimits{}.max_bytes;
constexpr std::size_t copied_at_once = 65536;
constexpr int most_left_out = 32;

class Sum {
public:
    Sum() { (void)crypto_hash_sha256_init(&state_); }
    void add(std::string_view bytes) {
        (void)crypto_hash_sha256_update(&state_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    }
    /// As sha256sum prints it.
    [[nodiscard]] std::string line(std::string_view name) {
        std::array<unsigned char, crypto_hash_sha256_BYTES> out{};
        (void)crypto_hash_sha256_final(&state_, out.data());
        std::array<char, 2 * crypto_hash_sha256_BYTES + 1> hex{};
        return fmt::format("{}  {}\n", sodium_bin2hex(hex.data(), hex.size(), out.data(), out.size()), name);
    }

private:
    crypto_hash_sha256_state state_{};
};

std::string contents_document(const BackupContents& c, const std::vector<std::uint64_t>& sizes) {
    json::array members, left_out;
    for (std::size_t i = 0; i < c.members.size(); ++i)
        members.push_back({{"name", c.members[i]}, {"bytes", sizes[i]}});
    for (const auto& [what, why] : c.left_out)
        left_out.push_back({{"what", what}, {"why", why}});
    return json::serialize(json::object{{"kind", contents_kind},
                                        {"form", backup_form},
                                        {"program", c.program},
                                        {"host", c.host},
                                        {"made_at", format_time(c.made_at_unix_s * 1'000'000'000)},
                                        {"members", std::move(members)},
                                        {"left_out", std::move(left_out)}}) +
           "\n";
}

BackupResult<> write_text(ByteSink& to, std::string_view name, std::string_view text, std::int64_t at_unix_s) {
    if (auto r = to.write(tar_header(name, text.size(), at_unix_s)); !r) return r;
    if (auto r = to.write(text); !r) return r;
    return to.write(std::string(tar_padding(text.size()), '\0'));
}

tl::unexpected<BackupFault> damaged(std::string text) { return backup_fault(Kind::damaged, std::move(text)); }
constexpr std::string_view cut_short = "it is cut short";

/// Reads one archive from its beginning to its end.
class Reader {
public:
    Reader(ByteSource& from, std::string folder) : from_(from), folder_(std::move(folder)) {}

    BackupResult<BackupContents> read() {
        if (!folder_.empty() && (::mkdir(folder_.c_str(), 0700) != 0 || ::mkdir((folder_ + "/dds").c_str(), 0700) != 0))
            return backup_fault(Kind::cannot_write, fmt::format("cannot make the folder {}: {}", folder_, std::strerror(errno)));
        if (auto r = contents(); !r) return tl::unexpected(r.error());
        for (std::size_t i = 0; i < contents_.members.size(); ++i) {
            if (auto r = member(contents_.members[i], sizes_[i]); !r) return tl::unexpected(r.error());
        }
        if (auto r = sums(); !r) return tl::unexpected(r.error());
        if (auto r = end(); !r) return tl::unexpected(r.error());
        return std::move(contents_);
    }

private:
    BackupResult<> exactly(std::span<char> into) {
        const auto n = from_.read(into);
        if (!n) return tl::unexpected(n.error());
        if (*n != into.size()) return damaged(std::string(cut_short));
        return {};
    }
    BackupResult<TarEntry> head() {
        std::array<char, tar_block> block{};
        if (auto r = exactly(block); !r) return tl::unexpected(r.error());
        auto entry = read_tar_header({block.data(), block.size()});
        if (!entry) return damaged("a head of a file in it is damaged");
        return std::move(*entry);
    }
    BackupResult<> padding(std::uint64_t bytes) {
        std::array<char, tar_block> block{};
        const std::span<char> rest(block.data(), tar_padding(bytes));
        if (auto r = exactly(rest); !r) return r;
        if (!std::ranges::all_of(rest, [](char c) { return c == '\0'; })) return damaged("something stands between the files in it");
        return {};
    }
    BackupResult<std::string> text(std::uint64_t bytes) {
        std::string s(bytes, '\0');
        if (auto r = exactly(s); !r) return tl::unexpected(r.error());
        if (auto r = padding(bytes); !r) return tl::unexpected(r.error());
        return s;
    }

    BackupResult<> contents() {
        const auto h = head();
        if (!h) return tl::unexpected(h.error());
        if (h->name != contents_member || h->bytes > most_contents) return damaged("its contents list is missing");
        const auto document = text(h->bytes);
        if (!document) return tl::unexpected(document.error());
        note(contents_member, *document);
        boost::system::error_code wrong;
        const json::value parsed = json::parse(*document, wrong);
        const auto* o = wrong ? nullptr : parsed.if_object();
        if (!o || text_of(*o, "kind") != contents_kind) return damaged("its contents list is damaged");
        const auto* form = o->if_contains("form");
        if (!form || !form->is_int64() || form->get_int64() < 1) return damaged("its contents list is damaged");
        if (form->get_int64() > backup_form)
            return backup_fault(Kind::newer, fmt::format("it was made by a newer axisgate ({}) than this one", text_of(*o, "program")));
        contents_.program = text_of(*o, "program");
        contents_.host = text_of(*o, "host");
        contents_.made_at_unix_s = h->at_unix_s;
        const auto* members = o->if_contains("members");
        const auto* left_out = o->if_contains("left_out");
        if (!members || !members->is_array() || !left_out || !left_out->is_array() || left_out->get_array().size() > most_left_out)
            return damaged("its contents list is damaged");
        for (const auto& m : members->get_array()) {
            const std::string name = m.is_object() ? text_of(m.get_object(), "name") : "";
            const auto* bytes = m.is_object() ? m.get_object().if_contains("bytes") : nullptr;
            const auto known = std::ranges::find(backup_members, name) != backup_members.end();
            if (!known || std::ranges::find(contents_.members, name) != contents_.members.end() || !bytes || !bytes->is_int64() ||
                bytes->get_int64() < 0)
                return damaged("its contents list names what no backup has, or twice the same");
            const auto size = static_cast<std::uint64_t>(bytes->get_int64());
            if (size > (name == database_member ? most_database : most_small))
                return damaged(fmt::format("{} in it is larger than it can be", name));
            contents_.members.push_back(name);
            sizes_.push_back(size);
        }
        if (contents_.members.empty() || contents_.members.front() != database_member) return damaged("there is no database in it");
        for (const auto& l : left_out->get_array()) {
            if (!l.is_object()) return damaged("its contents list is damaged");
            contents_.left_out.emplace_back(text_of(l.get_object(), "what"), text_of(l.get_object(), "why"));
        }
        return {};
    }

    BackupResult<> member(const std::string& name, std::uint64_t bytes) {
        const auto h = head();
        if (!h) return tl::unexpected(h.error());
        if (h->name != name || h->bytes != bytes) return damaged(fmt::format("where {} should be in it there is something else", name));
        std::unique_ptr<FileSink> file;
        if (!folder_.empty()) {
            auto made = FileSink::create(folder_ + "/" + name);
            if (!made) return tl::unexpected(made.error());
            file = std::move(*made);
        }
        Sum sum;
        std::string part(copied_at_once, '\0');
        for (std::uint64_t left = bytes; left > 0;) {
            const std::span<char> now(part.data(), static_cast<std::size_t>(std::min<std::uint64_t>(left, part.size())));
            if (auto r = exactly(now); !r) return r;
            const std::string_view got(now.data(), now.size());
            sum.add(got);
            if (file) {
                if (auto r = file->write(got); !r) return r;
            }
            left -= now.size();
        }
        sums_.emplace_back(name, sum.line(name));
        return padding(bytes);
    }

    BackupResult<> sums() {
        const auto h = head();
        if (!h) return tl::unexpected(h.error());
        if (h->name != sums_member || h->bytes > most_contents) return damaged("its checksums are missing");
        const auto reported = text(h->bytes);
        if (!reported) return tl::unexpected(reported.error());
        std::string_view rest = *reported;
        for (const auto& [name, line] : sums_) {
            if (!rest.starts_with(line)) return damaged(fmt::format("{} in it is not what its checksum says", name));
            rest.remove_prefix(line.size());
        }
        if (!rest.empty()) return damaged("its checksums are of other files");
        return {};
    }

    BackupResult<> end() {
        std::array<char, 2 * tar_block> zeros{};
        if (auto r = exactly(zeros); !r) return r;
        if (!std::ranges::all_of(zeros, [](char c) { return c == '\0'; })) return damaged("its end is damaged");
        char more = 0;
        const auto after = from_.read({&more, 1});
        if (!after) return tl::unexpected(after.error());
        if (*after != 0) return damaged("something was added to its end");
        return {};
    }

    void note(std::string_view name, std::string_view bytes) {
        Sum sum;
        sum.add(bytes);
        sums_.emplace_back(name, sum.line(name));
    }
    static std::string text_of(const json::object& o, std::string_view key) {
        const auto* v = o.if_contains(key);
        return v && v->is_string() ? std::string(v->get_string()) : std::string();
    }

    ByteSource& from_;
    std::string folder_;
    BackupContents contents_;
    std::vector<std::uint64_t> sizes_;
    std::vector<std::pair<std::string, std::string>> sums_;
};

/// Copies the decrypted content of a sealed one.
BackupResult<> copy_all(ByteSource& from, FileSink& to) {
    std::string part(copied_at_once, '\0');
    for (;;) {
        const auto n = from.read(part);
        if (!n) return tl::unexpected(n.error());
        if (auto r = to.write(std::string_view(part).substr(0, *n)); !r) return r;
        if (*n < part.size()) return to.finish();
    }
}
}  // namespace

BackupResult<> write_backup(ByteSink& to, BackupContents contents, const std::vector<BackupMember>& members) {
    std::vector<std::unique_ptr<FileSource>> files;
    std::vector<std::uint64_t> sizes;
    contents.members.clear();
    for (const auto& m : members) {
        auto file = FileSource::open(m.path);
        if (!file) return tl::unexpected(file.error());
        const std::uint64_t most = m.name == database_member ? most_database : most_small;
        if ((*file)->size() > most)
            return backup_fault(Kind::cannot_read, fmt::format("{} is larger than {} bytes, which no such file is", m.path, most));
        contents.members.push_back(m.name);
        sizes.push_back((*file)->size());
        files.push_back(std::move(*file));
    }
    const std::int64_t at = contents.made_at_unix_s;
    const std::string list = contents_document(contents, sizes);
    if (auto r = write_text(to, contents_member, list, at); !r) return r;
    Sum of_list;
    of_list.add(list);
    std::string sums = of_list.line(contents_member);
    std::string part(copied_at_once, '\0');
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (auto r = to.write(tar_header(members[i].name, sizes[i], at)); !r) return r;
        Sum sum;
        std::uint64_t done = 0;
        while (done <= sizes[i]) {  // one more read than necessary finds the end, or that the file has grown
            const auto n = files[i]->read(part);
            if (!n) return tl::unexpected(n.error());
            if (*n == 0) break;
            const std::string_view got = std::string_view(part).substr(0, *n);
            sum.add(got);
            if (auto r = to.write(got); !r) return r;
            done += *n;
        }
        if (done != sizes[i]) return backup_fault(Kind::cannot_read, members[i].path + " was written to while it was read: try again");
        if (auto r = to.write(std::string(tar_padding(done), '\0')); !r) return r;
        sums += sum.line(members[i].name);
    }
    if (auto r = write_text(to, sums_member, sums, at); !r) return r;
    return to.write(std::string(2 * tar_block, '\0'));
}

BackupResult<BackupContents> read_backup(ByteSource& from, const std::string& folder) { return Reader(from, folder).read(); }

BackupForm backup_form_of(std::string_view head) noexcept {
    if (head.starts_with(std::string_view("SQLite format 3\0", 16))) return BackupForm::database;
    if (head.starts_with(sealed_magic)) return BackupForm::sealed;
    if (head.starts_with(contents_member) && head.size() >= tar_block && head.substr(257, 5) == "ustar") return BackupForm::archive;
    return BackupForm::none;
}

BackupResult<BackupForm> backup_form_of_file(const std::string& path) {
    auto file = FileSource::open(path);
    if (!file) return tl::unexpected(file.error());
    std::array<char, tar_block> head{};
    const auto n = (*file)->read(head);
    if (!n) return tl::unexpected(n.error());
    return backup_form_of({head.data(), *n});
}

BackupResult<BackupContents> open_backup(const std::string& path, const std::string& passphrase, const std::string& folder) {
    const auto form = backup_form_of_file(path);
    if (!form) return tl::unexpected(form.error());
    auto file = FileSource::open(path);
    if (!file) return tl::unexpected(file.error());
    if (*form == BackupForm::archive) return read_backup(**file, folder);
    if (*form != BackupForm::sealed) return backup_fault(Kind::not_ours, "it is no backup of axisgate");
    auto open = Unsealer::begin(**file, passphrase);
    if (!open) return tl::unexpected(open.error());
    return read_backup(**open, folder);
}

BackupResult<> unseal_backup(std::string_view bytes, const std::string& passphrase, const std::string& plain) {
    TextSource sealed(bytes);
    auto open = Unsealer::begin(sealed, passphrase);
    if (!open) return tl::unexpected(open.error());
    auto to = FileSink::create(plain);
    if (!to) return tl::unexpected(to.error());
    return copy_all(**open, **to);
}

}  // namespace axisgate
