// The samples of a Photoshop file's merged picture turned into RGBA: whatever the mode, on white or not.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "io/foreign_colours.h"
#include "io/formats.h"
#include "io/psd_parts.h"

namespace probewarp {

namespace {

// ---- samples: of 8 bits (single bits too), of 16, and floating-point ones of 32 ----

/// No number is none of light; what lies far beyond the rest is held where sums of it still are numbers.
float sane(float v) { return std::isnan(v) ? 0 : std::clamp(v, -65536.0f, 65536.0f); }

/// row: big-endian samples of so many bits. A single bit that is set is black.
template <class Sample>
void unpack(Bytes row, int bits, std::span<Sample> samples) {
    for (std::size_t x = 0; x < samples.size(); ++x) {
        if constexpr (std::is_floating_point_v<Sample>)
            samples[x] = sane(std::bit_cast<float>(be32(row, x * 4)));
        else if constexpr (sizeof(Sample) == 2)
            samples[x] = Sample(be16(row, x * 2));
        else
            samples[x] = Sample(bits == 8 ? u8(row, x) : u8(row, x / 8) >> (7 - x % 8) & 1 ? 0 : 255);
    }
}

/// What a channel holds where the picture is white.
template <class Sample>
Sample white_of(const Psd& psd, std::size_t channel) {
    return psd.mode == PsdMode::lab && channel > 0 ? Sample(full<Sample> / 2 + 1) : full<Sample>;
}

/// The picture from the top, a row of all its channels at a time.
template <class Sample>
class SampleRows {
  public:
    /// channels: of that file, at their first rows; they stay there
    SampleRows(const Psd& psd, const PsdChannels& channels, bool salvage)
        : whole(!channels.fault), psd_(psd), salvage_(salvage), row_(psd.row_bytes()) {
        samples.assign(channels.list.size(), std::vector<Sample>(psd.width));
        for (const auto& channel : channels.list) channels_.push_back(channel->copy());
    }

    /// Reads the next row. False where it has lost its first channel.
    bool next() {
        bool there = true;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            try {
                channels_[i]->read(row_);
                unpack<Sample>(row_, psd_.bits, samples[i]);
                continue;
            } catch (const IncompleteFile& error) {
                if (first_row_ && i == 0) throw Error(error.what());
                if (!salvage_) throw;
            }
            whole = false;
            there = there && i > 0;
            const bool dark = psd_.mode == PsdMode::rgb && i < psd_.colours;
            std::fill(samples[i].begin(), samples[i].end(), dark ? Sample(0) : white_of<Sample>(psd_, i));
        }
        first_row_ = false;
        return there;
    }

    /// #channels x width: the colours, and then the alpha where there is one.
    std::vector<std::vector<Sample>> samples;
    bool whole;

  private:
    const Psd& psd_;
    bool salvage_;
    std::vector<std::unique_ptr<PsdChannel>> channels_;
    std::vector<std::byte> row_;
    bool first_row_ = true;
};

// ---- white under what is partly transparent ----

/// A wide enough signed number for products of two samples.
template <class Sample>
using Wide = std::conditional_t<std::is_floating_point_v<Sample>, Sample, std::int64_t>;

/// Whether the sample can be a colour that was merged onto white: then it is as near to white as the alpha
/// lets it shine through, but for rounding.
template <class Sample>
bool can_be_on_white(Sample sample, Sample alpha, Sample white) {
    constexpr Wide<Sample> all = full<Sample>, rounding = all / 128;
    const Wide<Sample> shining = (all - alpha) * white / all;
    if (sample < shining - rounding) return false;
    return white == full<Sample> || sample <= shining + alpha + rounding;
}

/// Whether all of the picture can be on white, as Photoshop merges what is partly transparent. Other programs
/// write the colours unmixed, and nothing in the file says so.
template <class Sample>
bool is_on_white(const Psd& psd, const PsdChannels& channels, bool salvage) {
    SampleRows<Sample> rows(psd, channels, salvage);
    for (std::size_t y = 0; y < psd.height; ++y) {
        if (!rows.next()) continue;
        const std::vector<Sample>& alpha = rows.samples.back();
        for (std::size_t c = 0; c < psd.colours; ++c)
            for (std::size_t x = 0; x < psd.width; ++x)
                if (alpha[x] > 0 && !can_be_on_white(rows.samples[c][x], alpha[x], white_of<Sample>(psd, c)))
                    return false;
    }
    return true;
}

/// Takes the white out again.
template <class Sample>
Sample without_white(Sample sample, Sample alpha, Sample white) {
    constexpr Wide<Sample> all = full<Sample>;
    if (alpha <= 0 || alpha >= all) return sample;
    const Wide<Sample> scaled = (Wide<Sample>(sample) - white) * all + Wide<Sample>(white) * alpha;
    if constexpr (std::is_floating_point_v<Sample>)
        return std::max(scaled / alpha, Sample(0));
    else
        return Sample(std::clamp<Wide<Sample>>((scaled + alpha / 2) / alpha, 0, all));
}

template <class Sample>
void remove_white(const Psd& psd, std::vector<std::vector<Sample>>& samples) {
    const std::vector<Sample>& alpha = samples.back();
    for (std::size_t c = 0; c < psd.colours; ++c)
        for (std::size_t x = 0; x < psd.width; ++x)
            samples[c][x] = without_white(samples[c][x], alpha[x], white_of<Sample>(psd, c));
}

// ---- colours ----

/// Null where the samples are RGB or grey as they are.
template <class Sample>
std::unique_ptr<const ToSrgb> conversion(const Psd& psd) {
    const int bits = int(sizeof(Sample)) * 8;
    if (psd.mode == PsdMode::cmyk || psd.mode == PsdMode::multichannel)
        return std::make_unique<ToSrgb>(ForeignColours::cmyk, psd.icc, bits);
    if (psd.mode == PsdMode::lab) return std::make_unique<ToSrgb>(ForeignColours::lab, psd.icc, bits);
    if (psd.bits == 32) return std::make_unique<ToSrgb>(ForeignColours::linear_rgb, psd.icc, bits);
    return nullptr;
}

/// The colour of one pixel of an indexed file. rgba: 4
void look_up(const Psd& psd, std::uint8_t* rgba) {
    const std::size_t index = rgba[0], colours = psd.palette.size() / 3;
    for (std::size_t c = 0; c < 3; ++c)
        rgba[c] = index < colours ? std::uint8_t(u8(psd.palette, c * colours + index)) : std::uint8_t(0);
}

/// Samples that stand in a pixel's place, put as RGBA needs them or the conversion to sRGB.
template <class Sample>
void arrange(const Psd& psd, Sample* rgba) {
    switch (psd.mode) {
        case PsdMode::bitmap:
        case PsdMode::grey:
        case PsdMode::duotone:
            rgba[1] = rgba[2] = rgba[0];
            break;
        case PsdMode::indexed:
            if constexpr (sizeof(Sample) == 1) look_up(psd, rgba);
            break;
        case PsdMode::multichannel:  // a single ink is taken for black
            if (psd.colours == 1) std::swap(rgba[0], rgba[3]);
            break;
        case PsdMode::lab:  // from Photoshop's 256 steps a unit to the 257 of ICC's
            if constexpr (sizeof(Sample) == 2)
                for (std::size_t c = 1; c < 3; ++c)
                    rgba[c] = Sample(std::min((rgba[c] * 257u + 128) / 256, 65535u));
            break;
        case PsdMode::rgb:
        case PsdMode::cmyk:
            break;
    }
}

template <class Sample>
void set_alpha(const Psd& psd, const std::vector<std::vector<Sample>>& samples, std::span<Sample> rgba) {
    for (std::size_t x = 0; x < psd.width; ++x) {
        const bool clear = psd.clear_index && Sample(*psd.clear_index) == samples[0][x];
        rgba[x * 4 + 3] = clear ? Sample(0) : psd.alpha ? samples.back()[x] : full<Sample>;
    }
}

/// samples: #channels x width; rgba: width x 4
template <class Sample>
void fill_row(const Psd& psd, const ToSrgb* to_srgb, const std::vector<std::vector<Sample>>& samples,
              std::span<Sample> rgba) {
    for (std::size_t x = 0; x < psd.width; ++x) {
        for (std::size_t c = 0; c < 4; ++c) rgba[x * 4 + c] = c < psd.colours ? samples[c][x] : full<Sample>;
        arrange(psd, &rgba[x * 4]);
    }
    if (to_srgb) to_srgb->convert(rgba);
    set_alpha(psd, samples, rgba);
}

/// What a picture's samples are: those of its file, but for floating-point ones.
template <class Sample>
using Stored = std::conditional_t<std::is_floating_point_v<Sample>, std::uint16_t, Sample>;

template <class Sample>
void store(std::span<const Sample> rgba, std::span<Stored<Sample>> to) {
    if constexpr (std::is_floating_point_v<Sample>)
        std::transform(rgba.begin(), rgba.end(), to.begin(),
                       [](float v) { return std::uint16_t(std::clamp(v, 0.0f, 1.0f) * 65535 + 0.5f); });
    else
        std::copy(rgba.begin(), rgba.end(), to.begin());
}

/// Throws where a row is damaged, so that a bad file does not cost the time that converting its colours
/// takes.
template <class Sample>
void look_through(const Psd& psd, const PsdChannels& channels) {
    SampleRows<Sample> rows(psd, channels, false);
    for (std::size_t y = 0; y < psd.height; ++y) rows.next();
}

template <class Sample>
Image read_pixels(const Psd& psd, bool salvage) {
    const PsdChannels channels = psd_channels(psd);
    if (channels.fault && !salvage) throw *channels.fault;
    const bool on_white =
        psd.alpha && psd.mode != PsdMode::indexed && is_on_white<Sample>(psd, channels, salvage);
    const std::unique_ptr<const ToSrgb> to_srgb = conversion<Sample>(psd);
    if (to_srgb && !salvage) look_through<Sample>(psd, channels);
    SampleRows<Sample> rows(psd, channels, salvage);
    Image image = blank_image((long long)(psd.width), (long long)(psd.height), psd.bits > 8 ? 16 : 8);
    auto& pixels = std::get<std::vector<Stored<Sample>>>(image.rgba);
    std::vector<Sample> rgba(psd.width * 4);
    for (std::size_t y = 0; y < psd.height; ++y) {
        if (!rows.next()) continue;
        if (on_white) remove_white(psd, rows.samples);
        fill_row<Sample>(psd, to_srgb.get(), rows.samples, rgba);
        store<Sample>(rgba, std::span(pixels).subspan(y * rgba.size(), rgba.size()));
    }
    image.incomplete = !rows.whole;
    return image;
}

}  // namespace

Image read_psd_pixels(const Psd& psd, bool salvage) {
    if (psd.mode == PsdMode::indexed && psd.palette.size() < 3)
        throw damaged(psd.label(), "it has no palette");
    if (psd.bits == 32) return read_pixels<float>(psd, salvage);
    if (psd.bits == 16) return read_pixels<std::uint16_t>(psd, salvage);
    return read_pixels<std::uint8_t>(psd, salvage);
}

}  // namespace probewarp
