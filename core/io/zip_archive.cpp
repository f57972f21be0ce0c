#include "io/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string_view>

namespace probewarp {

namespace {

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_source_t* source) const { zip_source_free(source); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};
template <class T>
using Owned = std::unique_ptr<T, Discard>;

/// The parts of a name between its slashes: at least one.
std::vector<std::string_view> parts_of(std::string_view name) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0; start <= name.size();) {
        const std::size_t end = std::min(name.find('/', start), name.size());
        parts.push_back(name.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

bool stays_inside(const std::string& name) {
    if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == ':'; }))
        return false;
    return std::ranges::none_of(
        parts_of(name), [](std::string_view part) { return part.empty() || part == "." || part == ".."; });
}

/// The name with the slashes and without the "./" that the format asks for; some archivers write others.
std::string usual_name(std::string name) {
    std::ranges::replace(name, '\\', '/');
    while (name.starts_with("./") && name.size() > 2) name.erase(0, 2);
    return name;
}

/// What desktops add to archives and folders: previews, places of icons, resource forks.
bool is_added_by_desktop(std::string_view name) {
    const std::vector<std::string_view> parts = parts_of(name);
    const std::string_view file = parts.back();
    return parts.front() == "__MACOSX" || file.starts_with("._") || file == ".DS_Store" ||
           file == "Thumbs.db" || file == "desktop.ini";
}

/// Reads the numbers and signatures of an archive.
struct Records {
    std::span<const std::byte> bytes;

    std::uint64_t number(std::size_t at, std::size_t count) const {
        std::uint64_t value = 0;
        for (std::size_t i = count; i-- > 0;)
            value = value << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
        return value;
    }
    bool is(std::size_t at, std::uint32_t signature) const { return number(at, 4) == signature; }
};

constexpr std::size_t end_size = 22, locator_size = 20, end64_size = 56;
constexpr std::uint32_t end_record = 0x06054b50, locator_record = 0x07064b50, end64_record = 0x06064b50;

/// How many members the end record at `at` promises, or the Zip64 one that its locator leads to.
std::uint64_t promised_members(const Records& records, std::size_t at) {
    if (at < locator_size || !records.is(at - locator_size, locator_record))
        return records.number(at + 10, 2);
    const std::size_t locator = at - locator_size;
    const std::uint64_t end64 = records.number(locator + 8, 8);
    if (end64 > locator || locator - end64 < end64_size || !records.is(end64, end64_record))
        throw Error("is damaged; expected a ZIP archive whose end leads to its directory");
    return std::max(records.number(end64 + 24, 8), records.number(end64 + 32, 8));
}

/// Calls `visit` with the place of each record whose comment ends with the file: one of them is the end
/// record, and a picture's bytes may look like another.
template <class Visit>
void each_end_record(const Records& records, const Visit& visit) {
    constexpr std::size_t longest_comment = 0xffff;
    const std::size_t size = records.bytes.size();
    for (std::size_t at = size - std::min(size, end_size + longest_comment); at + end_size <= size; ++at)
        if (records.is(at, end_record) && at + end_size + records.number(at + 20, 2) == size) visit(at);
}

/// Refuses an archive whose end promises more members than fit, before libzip makes room for them all.
void check_directory(std::span<const std::byte> bytes) {
    if (bytes.size() < end_size) throw Error("is truncated; expected a whole ZIP archive");
    const Records records{bytes};
    each_end_record(records, [&](std::size_t at) {
        if (promised_members(records, at) > max_zip_members)
            throw Error(fmt::format("has too many members; expected at most {}", max_zip_members));
    });
}

Owned<zip_t> open_for_reading(std::span<const std::byte> bytes) {
    zip_error_t error;
    zip_error_init(&error);
    Owned<zip_source_t> source(zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error));
    Owned<zip_t> archive(source ? zip_open_from_source(source.get(), ZIP_RDONLY | ZIP_CHECKCONS, &error)
                                : nullptr);
    zip_error_fini(&error);
    if (!archive)
        throw Error("is damaged or truncated; expected a whole ZIP archive without doubled members");
    source.release();  // the archive owns it now
    return archive;
}

/// How a member is packed, in words.
std::string packing(unsigned method) {
    switch (method) {
        case ZIP_CM_DEFLATE64:
            return "Deflate64";
        case ZIP_CM_BZIP2:
            return "bzip2";
        case ZIP_CM_LZMA:
            return "LZMA";
        case 20:
        case 93:
            return "Zstandard";
        case ZIP_CM_XZ:
            return "XZ";
        case ZIP_CM_PPMD:
            return "PPMd";
        default:
            return fmt::format("method {}", method);
    }
}

/// A member as the directory describes it.
struct Entry {
    zip_uint64_t index;
    std::string name;  ///< the usual one
    std::uint64_t size;
    unsigned method;
    bool encrypted;
};

/// All but folders and what desktops add.
std::vector<Entry> entries_of(zip_t* archive) {
    std::vector<Entry> entries;
    const zip_int64_t count = zip_get_num_entries(archive, 0);
    for (zip_uint64_t i = 0; i < zip_uint64_t(count); ++i) {
        zip_stat_t stat;
        constexpr zip_uint64_t needed =
            ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
        if (zip_stat_index(archive, i, ZIP_FL_ENC_GUESS, &stat) != 0 || (stat.valid & needed) != needed)
            throw Error("is damaged; expected a whole ZIP archive");
        std::string name = usual_name(stat.name);
        const bool folder = name.ends_with('/') && stat.size == 0;
        if (folder || is_added_by_desktop(name)) continue;
        entries.push_back(
            {i, std::move(name), stat.size, stat.comp_method, stat.encryption_method != ZIP_EM_NONE});
    }
    return entries;
}

void check_names(const std::vector<Entry>& entries) {
    std::set<std::string> names;
    for (const Entry& entry : entries) {
        if (entry.name.empty()) throw Error("has a member without a name; expected one for each");
        if (!stays_inside(entry.name))
            throw Error("has a member whose name points out of the archive; expected names inside it");
        if (!names.insert(entry.name).second)
            throw Error(fmt::format("has two members named {}; expected one", entry.name));
    }
}

void check_packing(const Entry& entry) {
    if (entry.encrypted)
        throw Error(
            fmt::format("has an encrypted member {}; expected none: zip its members again without a "
                        "password",
                        entry.name));
    if (entry.method != ZIP_CM_STORE && entry.method != ZIP_CM_DEFLATE)
        throw Error(
            fmt::format("has a member {} that is packed by {}; expected deflate or none: zip its "
                        "members again with one of these",
                        entry.name, packing(entry.method)));
}

std::vector<std::byte> read_member(zip_t* archive, const Entry& entry) {
    const Owned<zip_file_t> file(zip_fopen_index(archive, entry.index, 0));
    std::vector<std::byte> bytes(file ? std::size_t(entry.size) : 0);
    std::byte past{};
    if (!file || zip_fread(file.get(), bytes.data(), bytes.size()) != zip_int64_t(entry.size) ||
        zip_fread(file.get(), &past, 1) != 0)
        throw Error(fmt::format("has a damaged member {}; expected a whole ZIP archive", entry.name));
    return bytes;
}

}  // namespace

bool is_zip(std::span<const std::byte> bytes) {
    constexpr std::byte magic[] = {std::byte{'P'}, std::byte{'K'}, std::byte{3}, std::byte{4}};
    return bytes.size() >= 4 && std::equal(std::begin(magic), std::end(magic), bytes.begin());
}

void settle_streamed_members(std::span<std::byte> bytes) {
    constexpr std::uint32_t local_header = 0x04034b50, directory_entry = 0x02014b50;
    constexpr std::size_t local_size = 30, entry_size = 46, sized_behind = 8;
    const Records records{bytes};
    const auto is_there = [&](std::size_t at, std::size_t size, std::uint32_t signature) {
        return at <= bytes.size() && bytes.size() - at >= size && records.is(at, signature);
    };
    each_end_record(records, [&](std::size_t end) {
        std::size_t entry = records.number(end + 16, 4);
        for (std::uint64_t left = records.number(end + 10, 2); left > 0; --left) {
            if (!is_there(entry, entry_size, directory_entry)) return;
            const std::size_t local = records.number(entry + 42, 4);
            const bool streamed = is_there(local, local_size, local_header) &&
                                  (records.number(local + 6, 2) & sized_behind) != 0 &&
                                  records.number(local + 14, 8) == 0;  // checksum and packed size
            if (streamed) std::ranges::fill(bytes.subspan(local + 22, 4), std::byte{0});
            entry += entry_size + records.number(entry + 28, 2) + records.number(entry + 30, 2) +
                     records.number(entry + 32, 2);
        }
    });
}

std::vector<std::string> zip_names(std::span<const std::byte> bytes) {
    check_directory(bytes);
    const Owned<zip_t> archive = open_for_reading(bytes);
    std::vector<std::string> names;
    for (Entry& entry : entries_of(archive.get())) names.push_back(std::move(entry.name));
    return names;
}

std::vector<ZipMember> read_zip(std::span<const std::byte> bytes, std::size_t limit) {
    check_directory(bytes);
    const Owned<zip_t> archive = open_for_reading(bytes);
    const std::vector<Entry> entries = entries_of(archive.get());
    check_names(entries);
    std::vector<ZipMember> members;
    std::size_t total = 0;
    for (const Entry& entry : entries) {
        check_packing(entry);
        if (entry.size > limit - total)
            throw Error(fmt::format("holds more than expected: at most {} MiB", limit >> 20));
        total += std::size_t(entry.size);
        members.push_back({entry.name, read_member(archive.get(), entry), entry.method == ZIP_CM_STORE});
    }
    return members;
}

std::vector<std::byte> write_zip(std::span<const ZipMember> members) {
    const auto failed = [](const char* what) {
        return Error(fmt::format("the ZIP archive cannot be made: {}", what));
    };
    zip_error_t error;
    zip_error_init(&error);
    Owned<zip_source_t> result(zip_source_buffer_create(nullptr, 0, 0, &error));
    if (!result) throw failed(zip_error_strerror(&error));
    zip_source_keep(result.get());  // one reference for the archive, one for reading what it wrote
    Owned<zip_t> archive(zip_open_from_source(result.get(), ZIP_CREATE | ZIP_TRUNCATE, &error));
    if (!archive) throw failed(zip_error_strerror(&error));
    for (const ZipMember& member : members) {
        zip_source_t* source = zip_source_buffer(archive.get(), member.bytes.data(), member.bytes.size(), 0);
        const zip_int64_t index =
            source ? zip_file_add(archive.get(), member.name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
        if (index < 0) {
            zip_source_free(source);
            throw failed(zip_strerror(archive.get()));
        }
        constexpr zip_uint16_t midnight = 0, first_of_1980 = (1 << 5) | 1;
        const auto at = zip_uint64_t(index);
        zip_set_file_compression(archive.get(), at, member.stored ? ZIP_CM_STORE : ZIP_CM_DEFLATE, 0);
        zip_file_set_dostime(archive.get(), at, midnight, first_of_1980, 0);
    }
    if (zip_close(archive.get()) != 0) throw failed(zip_strerror(archive.get()));
    archive.release();

    zip_stat_t stat;
    if (zip_source_stat(result.get(), &stat) != 0 || zip_source_open(result.get()) != 0)
        throw failed("no result");
    std::vector<std::byte> bytes(stat.size);
    const zip_int64_t read = zip_source_read(result.get(), bytes.data(), bytes.size());
    zip_source_close(result.get());
    if (read != zip_int64_t(bytes.size())) throw failed("short result");
    return bytes;
}

}  // namespace probewarp
