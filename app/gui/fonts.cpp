#include "gui/fonts.h"

#include <imgui_freetype.h>

#include <cmath>
#include <filesystem>
#include <initializer_list>

namespace probewarp {

namespace {

constexpr const char* debian = "/usr/share/fonts/";

ImFont* load(std::initializer_list<const char*> candidates, float size, const ImWchar* ranges) {
    ImGuiIO& io = ImGui::GetIO();
    std::error_code ignored;
    for (const char* candidate : candidates) {
        const std::filesystem::path path = std::filesystem::path(debian) / candidate;
        if (std::filesystem::is_regular_file(path, ignored))
            return io.Fonts->AddFontFromFileTTF(path.c_str(), std::round(size), nullptr, ranges);
    }
    return io.Fonts->AddFontDefault();
}

/// Only the glyphs that are used: rasterising thousands would be most of the start.
ImVector<ImWchar> ranges_of(const char* text) {
    ImFontGlyphRangesBuilder builder;
    builder.AddText(text);
    ImVector<ImWchar> ranges;
    builder.BuildRanges(&ranges);
    return ranges;
}

}  // namespace

Fonts load_fonts(float scale) {
    // Latin with its extensions, Greek, Cyrillic, punctuation, arrows and mathematical signs.
    static constexpr ImWchar text[] = {0x20,   0x24f,  0x370,  0x52f,  0x2010, 0x205e, 0x2190,
                                       0x21ff, 0x2200, 0x22ff, 0x25cf, 0x25cf, 0};
    static constexpr ImWchar latin[] = {0x20, 0xff, 0};  // of the one sentence that is large
    const auto regular = {"opentype/inter/Inter-Regular.otf",
                          "truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                          "truetype/dejavu/DejaVuSans.ttf"};
    const auto bold = {"opentype/inter/Inter-SemiBold.otf",
                       "truetype/roboto/unhinted/RobotoTTF/Roboto-Medium.ttf",
                       "truetype/dejavu/DejaVuSans-Bold.ttf"};
    const auto symbols = {"truetype/materialdesignicons-webfont/materialdesignicons-webfont.ttf"};
    static const ImVector<ImWchar> icons = ranges_of(icon::all);
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    // ImGui's size is from ascender to descender, 1.21 times the em of Inter that designers mean by "13 px".
    constexpr float em = 1.21f;
    Fonts fonts;
    fonts.text = load(regular, 13 * em * scale, text);
    fonts.strong = load(bold, 12.5f * em * scale, text);
    fonts.small = load(regular, 11.5f * em * scale, text);
    fonts.large = load(bold, 18 * em * scale, latin);
    fonts.icons = load(symbols, 20 * scale, icons.Data);
    fonts.icons_small = load(symbols, 16 * scale, icons.Data);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    return fonts;
}

}  // namespace probewarp
