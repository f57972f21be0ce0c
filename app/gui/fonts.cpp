#include "gui/fonts.h"

#include <ft2build.h>
#include <imgui_freetype.h>
#include <imgui_internal.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace probewarp {

namespace {

using Candidates = std::initializer_list<const char*>;

constexpr const char* debian = "/usr/share/fonts/";

constexpr Candidates regular = {"opentype/inter/Inter-Regular.otf",
                                "truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                                "truetype/dejavu/DejaVuSans.ttf"};
constexpr Candidates bold = {"opentype/inter/Inter-SemiBold.otf",
                             "truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf",
                             "truetype/dejavu/DejaVuSans-Bold.ttf"};
constexpr Candidates symbols = {"truetype/materialdesignicons-webfont/materialdesignicons-webfont.ttf"};

/// For other scripts, the better ones first: of Debian's fonts-noto-cjk, fonts-wqy-microhei,
/// fonts-droid-fallback, fonts-noto-core, fonts-noto-ui-core, fonts-dejavu-core, fonts-freefont-ttf and
/// fonts-unifont.
constexpr const char* fallbacks[] = {"opentype/noto/NotoSansCJK-Regular.ttc",
                                     "truetype/wqy/wqy-microhei.ttc",
                                     "truetype/droid/DroidSansFallbackFull.ttf",
                                     "truetype/noto/NotoSansArabic-Regular.ttf",
                                     "truetype/noto/NotoSansArabicUI-Regular.ttf",
                                     "truetype/noto/NotoSansHebrew-Regular.ttf",
                                     "truetype/dejavu/DejaVuSans.ttf",
                                     "truetype/noto/NotoSansThaiUI-Regular.ttf",
                                     "truetype/noto/NotoSansDevanagariUI-Regular.ttf",
                                     "truetype/noto/NotoSansBengaliUI-Regular.ttf",
                                     "truetype/noto/NotoSansGujaratiUI-Regular.ttf",
                                     "truetype/noto/NotoSansGurmukhiUI-Regular.ttf",
                                     "truetype/noto/NotoSansKannadaUI-Regular.ttf",
                                     "truetype/noto/NotoSansKhmerUI-Regular.ttf",
                                     "truetype/noto/NotoSansLaoUI-Regular.ttf",
                                     "truetype/noto/NotoSansMalayalamUI-Regular.ttf",
                                     "truetype/noto/NotoSansMyanmarUI-Regular.ttf",
                                     "truetype/noto/NotoSansOriyaUI-Regular.ttf",
                                     "truetype/noto/NotoSansSinhalaUI-Regular.ttf",
                                     "truetype/noto/NotoSansTamilUI-Regular.ttf",
                                     "truetype/noto/NotoSansTeluguUI-Regular.ttf",
                                     "truetype/noto/NotoSansEthiopic-Regular.ttf",
                                     "truetype/freefont/FreeSans.ttf",
                                     "truetype/freefont/FreeSerif.ttf",
                                     "opentype/unifont/unifont.otf",
                                     "truetype/unifont/unifont.ttf"};

// Latin with its extensions, Greek, Cyrillic, punctuation, arrows and mathematical signs.
constexpr ImWchar usual[] = {0x20,   0x24f,  0x370,  0x52f,  0x2010, 0x205e, 0x2190,
                             0x21ff, 0x2200, 0x22ff, 0x25cf, 0x25cf, 0};
constexpr ImWchar latin[] = {0x20, 0xff, 0};  // of the one sentence that is large

// ImGui's size is from ascender to descender, 1.21 times the em of Inter that designers mean by "13 px".
constexpr float em = 1.21f;
constexpr float text_size = 13 * em, strong_size = 12.5f * em, small_size = 11.5f * em, large_size = 18 * em;

bool is_usual(ImWchar c) {
    for (std::size_t i = 0; usual[i] != 0; i += 2)
        if (c >= usual[i] && c <= usual[i + 1]) return true;
    return false;
}

/// The first of the files that is there; empty where none is.
std::filesystem::path first_of(std::span<const char* const> candidates) {
    std::error_code ignored;
    for (const char* candidate : candidates) {
        const std::filesystem::path path = std::filesystem::path(debian) / candidate;
        if (std::filesystem::is_regular_file(path, ignored)) return path;
    }
    return {};
}

ImFont* load(Candidates candidates, float size, const ImWchar* ranges) {
    const std::filesystem::path path = first_of(std::span(candidates.begin(), candidates.size()));
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    if (path.empty()) return atlas.AddFontDefault();
    return atlas.AddFontFromFileTTF(path.c_str(), std::round(size), nullptr, ranges);
}

/// Only the glyphs that are used: rasterising thousands would be most of the start.
ImVector<ImWchar> ranges_of(const char* text) {
    ImFontGlyphRangesBuilder builder;
    builder.AddText(text);
    ImVector<ImWchar> ranges;
    builder.BuildRanges(&ranges);
    return ranges;
}

/// A font and the characters that are taken from it.
struct Share {
    std::filesystem::path path;
    ImVector<ImWchar> ranges;
};

/// Takes those characters out of `wanted` that the font has; empty where it has none or cannot be read.
Characters taken_from(FT_Library library, const std::filesystem::path& path, Characters& wanted) {
    Characters taken;
    FT_Face face = nullptr;
    if (FT_New_Face(library, path.c_str(), 0, &face) != 0) return taken;
    std::copy_if(wanted.begin(), wanted.end(), std::inserter(taken, taken.end()),
                 [face](ImWchar c) { return FT_Get_Char_Index(face, c) != 0; });
    FT_Done_Face(face);
    for (const ImWchar c : taken) wanted.erase(c);
    return taken;
}

/// Which of the fonts gives which of the characters; what none has is left out.
std::vector<Share> shares_of(Characters wanted) {
    std::vector<Share> shares;
    FT_Library library = nullptr;
    if (wanted.empty() || FT_Init_FreeType(&library) != 0) return shares;
    std::vector<const char*> paths = {*std::begin(regular)};
    paths.insert(paths.end(), std::begin(fallbacks), std::end(fallbacks));
    for (const char* candidate : paths) {
        const std::filesystem::path path = first_of(std::span(&candidate, 1));
        const Characters taken = path.empty() ? Characters() : taken_from(library, path, wanted);
        if (taken.empty()) continue;
        ImFontGlyphRangesBuilder builder;
        for (const ImWchar c : taken) builder.AddChar(c);
        builder.BuildRanges(&shares.emplace_back(Share{path, {}}).ranges);
    }
    FT_Done_FreeType(library);
    return shares;
}

/// Adds the shares to the font that was loaded last.
ImFont* with_shares(ImFont* font, float size, const std::vector<Share>& shares) {
    ImFontConfig config;
    config.MergeMode = true;
    for (const Share& share : shares)
        ImGui::GetIO().Fonts->AddFontFromFileTTF(share.path.c_str(), std::round(size), &config,
                                                 share.ranges.Data);
    return font;
}

}  // namespace

void Glyphs::ask(std::string_view text) {
    const char *at = text.data(), *const end = at + text.size();
    while (at < end) {
        unsigned character = 0;
        at += ImTextCharFromUtf8(&character, at, end);
        if (character >= 0x80 && character <= IM_UNICODE_CODEPOINT_MAX && !is_usual(ImWchar(character)))
            asked.insert(ImWchar(character));
    }
}

bool Glyphs::update(float scale) {
    Characters wanted = std::exchange(asked, {});
    const std::size_t most = most_characters(scale);
    while (wanted.size() > most) wanted.erase(std::prev(wanted.end()));
    if (std::includes(loaded.begin(), loaded.end(), wanted.begin(), wanted.end())) return false;
    if (loaded.size() + wanted.size() > most) loaded.clear();
    loaded.insert(wanted.begin(), wanted.end());
    return true;
}

std::size_t most_characters(float scale) {
    constexpr float pixels = 8e6f;  // 32 MB of RGBA
    constexpr float squares = text_size * text_size + strong_size * strong_size + small_size * small_size;
    return std::size_t(std::min(2000.0f, pixels / (squares * scale * scale)));
}

Fonts load_fonts(float scale) { return load_fonts_with(scale, {}); }

Fonts load_fonts_with(float scale, const Characters& more) {
    static const ImVector<ImWchar> icons = ranges_of(icon::all);
    const std::vector<Share> shares = shares_of(more);
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    const auto text = [&](Candidates candidates, float size) {
        return with_shares(load(candidates, size * scale, usual), size * scale, shares);
    };
    Fonts fonts;
    fonts.text = text(regular, text_size);
    fonts.strong = text(bold, strong_size);
    fonts.small = text(regular, small_size);
    fonts.large = load(bold, large_size * scale, latin);
    fonts.icons = load(symbols, 20 * scale, icons.Data);
    fonts.icons_small = load(symbols, 16 * scale, icons.Data);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    atlas.ClearInputData();  // the fonts' files, each as often as it is used
    return fonts;
}

}  // namespace probewarp
