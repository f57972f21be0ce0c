#include "io/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <memory>
#include <set>

namespace probewarp {

namespace {

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_source_t* source) const { zip_source_free(source); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};
template <class T>
using Owned = std::unique_ptr<T, Discard>;

bool stays_inside(const std::string& name) {
    if (name.empty() || name.front() == '/' || name.back() == '/') return false;
    if (std::any_of(name.begin(), name.end(),
                    [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == ':'; }))
        return false;
    for (std::size_t start = 0; start <= name.size();) {
        const std::size_t end = std::min(name.find('/', start), name.size());
        const std::string part = name.substr(start, end - start);
        if (part.empty() || part == "." || part == "..") return false;
        start = end + 1;
    }
    return true;
}

/// Refuses an archive whose end promises more members than fit, before libzip makes room for them all.
void check_directory(std::span<const std::byte> bytes) {
    constexpr std::size_t end_size = 22, longest_comment = 0xffff;
    const auto byte = [&bytes](std::size_t at) { return std::to_integer<unsigned>(bytes[at]); };
    const auto is = [&](std::size_t at, unsigned kind, unsigned version) {
        return byte(at) == 'P' && byte(at + 1) == 'K' && byte(at + 2) == kind && byte(at + 3) == version;
    };
    if (bytes.size() < end_size) throw Error("is truncated; expected a whole ZIP archive");
    const std::size_t first = bytes.size() - std::min(bytes.size(), end_size + longest_comment);
    for (std::size_t at = first; at + end_size <= bytes.size(); ++at) {
        // The end record is the one whose comment ends with the file: a picture's bytes may look like one
        // too.
        const std::size_t comment = byte(at + 20) | byte(at + 21) << 8;
        if (!is(at, 5, 6) || at + end_size + comment != bytes.size()) continue;
        const bool large = at >= 20 && is(at - 20, 6, 7);  // the locator of a Zip64 directory
        if (large || (byte(at + 10) | byte(at + 11) << 8) > max_zip_members)
            throw Error(fmt::format("has too many members; expected at most {}", max_zip_members));
    }
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

std::vector<std::byte> read_member(zip_t* archive, zip_uint64_t index, std::size_t size,
                                   const std::string& name) {
    Owned<zip_file_t> file(zip_fopen_index(archive, index, 0));
    std::vector<std::byte> bytes(file ? size : 0);
    std::byte past{};
    if (!file || zip_fread(file.get(), bytes.data(), size) != zip_int64_t(size) ||
        zip_fread(file.get(), &past, 1) != 0)
        throw Error(fmt::format("has a damaged member {}; expected a whole ZIP archive", name));
    return bytes;
}

}  // namespace

bool is_zip(std::span<const std::byte> bytes) {
    constexpr std::byte magic[] = {std::byte{'P'}, std::byte{'K'}, std::byte{3}, std::byte{4}};
    return bytes.size() >= 4 && std::equal(std::begin(magic), std::end(magic), bytes.begin());
}

std::vector<ZipMember> read_zip(std::span<const std::byte> bytes, std::size_t limit) {
    check_directory(bytes);
    const Owned<zip_t> archive = open_for_reading(bytes);
    const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
    std::vector<ZipMember> members;
    std::set<std::string> names;
    std::size_t total = 0;
    for (zip_uint64_t i = 0; i < zip_uint64_t(count); ++i) {
        zip_stat_t stat;
        constexpr zip_uint64_t needed =
            ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
        if (zip_stat_index(archive.get(), i, ZIP_FL_ENC_GUESS, &stat) != 0 || (stat.valid & needed) != needed)
            throw Error("is damaged; expected a whole ZIP archive");
        const std::string name = stat.name;
        if (!stays_inside(name))
            throw Error("has a member whose name points out of the archive; expected names inside it");
        if (!names.insert(name).second)
            throw Error(fmt::format("has two members named {}; expected one", name));
        if (stat.encryption_method != ZIP_EM_NONE)
            throw Error(fmt::format("has an encrypted member {}; expected none", name));
        if (stat.size > limit - total)
            throw Error(fmt::format("holds more than expected: at most {} MiB", limit >> 20));
        total += std::size_t(stat.size);
        members.push_back({name, read_member(archive.get(), i, std::size_t(stat.size), name),
                           stat.comp_method == ZIP_CM_STORE});
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
