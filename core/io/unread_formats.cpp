#include "io/unread_formats.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace probewarp {

namespace {

using std::string_view;

// What a person can do. Each completes "expected PNG, JPEG or another, so ...".
constexpr string_view convert = "convert it to PNG first";
constexpr string_view convert_deep = "convert it to PNG with 16 bits a channel first";
constexpr string_view export_it = "export it as PNG from the program that made it";
constexpr string_view draw_it = "export it as PNG, in the size that you need";
constexpr string_view page = "export the page as PNG";
constexpr string_view frame = "export a frame of it as PNG";
constexpr string_view develop = "develop it and export it as PNG with 16 bits a channel";
constexpr string_view unpack = "unpack it and open the picture that is in it";
constexpr string_view save_picture = "save the picture itself rather than the page around it";
constexpr string_view choose_picture = "choose a picture";

bool has_at(Bytes bytes, std::size_t at, string_view text) {
    return bytes.size() >= at + text.size() &&
           std::equal(text.begin(), text.end(), bytes.begin() + std::ptrdiff_t(at),
                      [](char c, std::byte b) { return std::byte(c) == b; });
}

/// A file whose kind one or two runs of characters tell.
struct Signature {
    std::size_t at;
    string_view text;
    string_view what;  // "a WebP picture"
    string_view remedy;
    std::size_t second_at = 0;
    string_view second{};
};

#define BYTES(literal) string_view(literal, sizeof(literal) - 1)  // with the zeros in it

// In the order in which they are tried: the longer signature of two stands first.
constexpr std::array signatures{
    Signature{0, "RIFF", "a WebP picture", convert, 8, "WEBP"},
    Signature{0, "RIFF", "a film (AVI)", frame, 8, "AVI "},
    Signature{0, "RIFF", "a sound", choose_picture, 8, "WAVE"},
    Signature{0, "RIFF", "a CorelDRAW drawing", draw_it, 8, "CDR"},
    Signature{0, BYTES("\0\0\0\x0CJXL \r\n\x87\n"), "a JPEG XL picture", convert},
    Signature{0, BYTES("\xFF\x0A"), "a JPEG XL picture", convert},
    Signature{0, BYTES("\0\0\0\x0CjP  \r\n\x87\n"), "a JPEG 2000 picture", convert},
    Signature{0, BYTES("\xFF\x4F\xFF\x51"), "a JPEG 2000 picture", convert},
    Signature{0, BYTES("II\xBC\x01"), "a JPEG XR picture", convert},
    Signature{0, BYTES("II*\0"), "a raw photograph (Canon CR2)", develop, 8, "CR"},
    Signature{0, BYTES("II*\0"), "a TIFF picture or a raw photograph", convert_deep},
    Signature{0, BYTES("MM\0*"), "a TIFF picture or a raw photograph", convert_deep},
    Signature{0, BYTES("II+\0"), "a BigTIFF picture", convert_deep},
    Signature{0, BYTES("MM\0+"), "a BigTIFF picture", convert_deep},
    Signature{0, "IIRO", "a raw photograph (Olympus ORF)", develop},
    Signature{0, "IIRS", "a raw photograph (Olympus ORF)", develop},
    Signature{0, "MMOR", "a raw photograph (Olympus ORF)", develop},
    Signature{0, BYTES("IIU\0"), "a raw photograph (Panasonic RW2)", develop},
    Signature{0, "FUJIFILMCCD-RAW", "a raw photograph (Fujifilm RAF)", develop},
    Signature{0, BYTES("\0MRM"), "a raw photograph (Minolta MRW)", develop},
    Signature{0, "FOVb", "a raw photograph (Sigma X3F)", develop},
    Signature{0, "gimp xcf", "a GIMP picture (XCF)", export_it},
    Signature{0, "Paint Shop Pro Image File", "a PaintShop Pro picture", export_it},
    Signature{0, "PDN3", "a paint.net picture", export_it},
    Signature{0, "CSFCHUNK", "a Clip Studio Paint picture", export_it},
    Signature{0, BYTES("\0\xFFKA"), "an Affinity document", export_it},
    Signature{0, "BLENDER", "a Blender scene", export_it},
    Signature{0, "icns", "an icon (ICNS)", convert},
    Signature{0, "%PDF-", "a PDF document", page},
    Signature{0, "%!PS", "a PostScript document", page},
    Signature{0, BYTES("\xC5\xD0\xD3\xC6"), "a PostScript document (EPS)", page},
    Signature{0, "AT&TFORM", "a DjVu document", page},
    Signature{0, BYTES("\xD7\xCD\xC6\x9A"), "a Windows metafile (WMF)", draw_it},
    Signature{40, " EMF", "a Windows metafile (EMF)", draw_it},
    Signature{0, BYTES("v/1\x01"), "an OpenEXR picture", convert_deep},
    Signature{0, "#?RADIANCE", "a Radiance picture (HDR)", convert_deep},
    Signature{0, "#?RGBE", "a Radiance picture (HDR)", convert_deep},
    Signature{0, "DDS ", "a texture (DDS)", convert},
    Signature{0, BYTES("\xABKTX"), "a texture (KTX)", convert},
    Signature{0, "qoif", "a QOI picture", convert},
    Signature{0, "FLIF", "a FLIF picture", convert},
    Signature{0, "farbfeld", "a farbfeld picture", convert_deep},
    Signature{0, BYTES("BPG\xFB"), "a BPG picture", convert},
    Signature{0, BYTES("\x8AMNG\r\n\x1A\n"), "an MNG animation", frame},
    Signature{0, BYTES("\x8BJNG\r\n\x1A\n"), "a JNG picture", convert},
    Signature{0, BYTES("\x0A\0\1"), "a PCX picture", convert},
    Signature{0, BYTES("\x0A\2\1"), "a PCX picture", convert},
    Signature{0, BYTES("\x0A\3\1"), "a PCX picture", convert},
    Signature{0, BYTES("\x0A\4\1"), "a PCX picture", convert},
    Signature{0, BYTES("\x0A\5\1"), "a PCX picture", convert},
    Signature{0, BYTES("\x01\xDA\0"), "an SGI picture", convert},
    Signature{0, BYTES("\x01\xDA\1"), "an SGI picture", convert},
    Signature{0, BYTES("\x59\xA6\x6A\x95"), "a Sun raster picture", convert},
    Signature{0, "FORM", "an Amiga picture (ILBM)", convert, 8, "ILBM"},
    Signature{0, "SIMPLE  =", "a FITS picture", convert_deep},
    Signature{128, "DICM", "a DICOM picture", convert_deep},
    Signature{0, "/* XPM */", "an XPM picture", convert},
    Signature{0, BYTES("\x1A\x45\xDF\xA3"), "a film (Matroska or WebM)", frame},
    Signature{30, "mimetypeapplication/x-probewarp", "a Probewarp project", choose_picture},
    Signature{0, BYTES("PK\3\4"), "a ZIP archive", unpack},
    Signature{0, BYTES("\x1F\x8B"), "a file packed by gzip", unpack},
    Signature{0, "BZh", "a file packed by bzip2", unpack},
    Signature{0,
              BYTES("\xFD"
                    "7zXZ\0"),
              "a file packed by xz", unpack},
    Signature{0, BYTES("\x28\xB5\x2F\xFD"), "a file packed by Zstandard", unpack},
    Signature{0, BYTES("7z\xBC\xAF\x27\x1C"), "a 7-Zip archive", unpack},
    Signature{0, "Rar!", "a RAR archive", unpack},
    Signature{257, "ustar", "a TAR archive", unpack},
    Signature{0, "version https://git-lfs", "a note of Git LFS in the place of the file", "fetch the file"},
};

#undef BYTES

/// ISO's base media: what the first brand that we know says of the file.
struct Brand {
    string_view brand, what, remedy;
};

constexpr std::array brands{
    Brand{"avif", "an AVIF picture", convert}, Brand{"avis", "an AVIF animation", frame},
    Brand{"heic", "a HEIC picture", convert},  Brand{"heix", "a HEIC picture", convert},
    Brand{"heim", "a HEIC picture", convert},  Brand{"heis", "a HEIC picture", convert},
    Brand{"hevc", "a HEIC animation", frame},  Brand{"mif1", "a HEIF picture", convert},
    Brand{"msf1", "a HEIF animation", frame},  Brand{"crx ", "a raw photograph (Canon CR3)", develop},
};

struct Named {
    string_view what, remedy;
};

/// A file that starts with an `ftyp` box: its size, major brand, version, compatible brands.
std::optional<Named> base_media(Bytes file) {
    if (!has_at(file, 4, "ftyp") || file.size() < 16) return {};
    const std::size_t end = std::min<std::size_t>({be32(file, 0), file.size(), 128});
    // A general brand as the major one says less than a compatible one.
    for (const Brand& brand : brands)
        for (std::size_t at = 8; at + 4 <= end; at += 4)
            if (has_at(file, at, brand.brand)) return Named{brand.what, brand.remedy};
    return Named{"a film", frame};
}

/// Windows' icons and pointers: zeros, the kind, and a list of pictures, each with its place in the file.
std::optional<Named> icon(Bytes file) {
    constexpr std::size_t header_bytes = 6, entry_bytes = 16;
    if (file.size() < header_bytes + entry_bytes || le16(file, 0) != 0) return {};
    const std::size_t kind = le16(file, 2), count = le16(file, 4), place = le32(file, 18);
    if (count == 0 || place < header_bytes + count * entry_bytes || place >= file.size()) return {};
    if (kind == 1) return Named{"an icon (ICO)", convert};
    if (kind == 2) return Named{"a pointer (CUR)", convert};
    return {};
}

/// Markup, whose first words may stand behind comments and declarations.
std::optional<Named> markup(Bytes file) {
    std::string start;
    for (const std::byte b : file.first(std::min<std::size_t>(file.size(), 4096))) {
        const char c = char(b);
        if (c != 0) start.push_back(c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c);  // 0: of UTF-16
    }
    const std::size_t first = start.find_first_not_of(" \t\r\n\xEF\xBB\xBF\xFF\xFE");
    if (first == std::string::npos || start[first] != '<') return {};
    if (start.find("<svg") != std::string::npos) return Named{"an SVG drawing", draw_it};
    if (start.find("<html") != std::string::npos || start.find("<!doctype html") != std::string::npos)
        return Named{"a web page", save_picture};
    if (start.compare(first, 5, "<?xml") == 0) return Named{"an XML document", choose_picture};
    return {};
}

std::string clause(const Named& named) {
    return std::string("is ")
        .append(named.what)
        .append(", which cannot be read; expected ")
        .append(readable_formats)
        .append(", so ")
        .append(named.remedy);
}

// ---- ZIP archives ----

/// What the member "mimetype", where it is the first, says of the archive.
constexpr std::array mimetypes{
    Brand{"image/openraster", "an OpenRaster picture", export_it},
    Brand{"application/x-krita", "a Krita picture", export_it},
    Brand{"application/vnd.oasis.opendocument", "an OpenDocument file", export_it},
    Brand{"application/epub", "a book (EPUB)", choose_picture},
};

/// What a member of that name says.
constexpr std::array members{
    Brand{"maindoc.xml", "a Krita picture", export_it},
    Brand{"stack.xml", "an OpenRaster picture", export_it},
    Brand{"Document.archive", "a Procreate picture", export_it},
    Brand{"word/document.xml", "a Word document", choose_picture},
    Brand{"ppt/presentation.xml", "a presentation", choose_picture},
    Brand{"xl/workbook.xml", "a spreadsheet", choose_picture},
};

/// Calls see(name) for the members that the archive's directory lists.
template <class See>
void each_member(Bytes zip, const See& see) {
    constexpr std::size_t end_bytes = 22, entry_bytes = 46, longest_comment = 65535;
    if (zip.size() < end_bytes) return;
    const std::size_t last = zip.size() - end_bytes;
    std::size_t at = zip.size();
    for (std::size_t back = 0; back <= std::min(last, longest_comment) && at == zip.size(); ++back)
        if (has_at(zip, last - back, "PK\5\6")) at = le32(zip, last - back + 16);
    while (at < zip.size() && zip.size() - at >= entry_bytes && has_at(zip, at, "PK\1\2")) {
        const std::size_t name = le16(zip, at + 28), rest = le16(zip, at + 30) + le16(zip, at + 32);
        if (zip.size() - at - entry_bytes < name) return;
        see(zip.subspan(at + entry_bytes, name));
        at += entry_bytes + name + rest;
    }
}

}  // namespace

std::optional<std::string> unread_archive(Bytes zip) {
    // The first member's name, of eight characters, and its bytes, where they are stored as they are.
    if (has_at(zip, 30, "mimetype"))
        for (const Brand& type : mimetypes)
            if (has_at(zip, 38, type.brand)) return clause({type.what, type.remedy});
    std::optional<std::string> found;
    each_member(zip, [&](Bytes name) {
        for (const Brand& member : members)
            if (!found && name.size() == member.brand.size() && has_at(name, 0, member.brand))
                found = clause({member.what, member.remedy});
    });
    return found;
}

std::optional<std::string> unread_format(Bytes file) {
    if (const auto named = base_media(file)) return clause(*named);
    if (const auto named = icon(file)) return clause(*named);
    if (const auto named = markup(file)) return clause(*named);
    if (has_at(file, 0, "PK\3\4"))
        if (auto named = unread_archive(file)) return named;
    for (const Signature& s : signatures)
        if (has_at(file, s.at, s.text) && has_at(file, s.second_at, s.second))
            return clause({s.what, s.remedy});
    return {};
}

}  // namespace probewarp
