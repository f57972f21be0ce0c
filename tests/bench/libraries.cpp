#include "libraries.h"

#include <cstdio>
#include <cstdlib>
// libjpeg's header wants stdio's first.
#include <jpeglib.h>
#include <png.h>
#include <spng.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace probewarp::bench {

std::vector<unsigned char> rgb_of(const Image& image) {
    const auto& rgba = std::get<0>(image.rgba);
    std::vector<unsigned char> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), &rgba[i], &rgba[i] + 3);
    return rgb;
}

std::size_t stb_png(std::span<const unsigned char> rgb, int width, int height) {
    int length = 0;
    std::free(stbi_write_png_to_mem(rgb.data(), width * 3, width, height, 3, &length));
    return std::size_t(length);
}

std::size_t libpng_best(std::span<const unsigned char> rgb, int width, int height) {
    std::size_t length = 0;
    png_struct* png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_info* info = png_create_info_struct(png);
    png_set_write_fn(
        png, &length,
        [](png_struct* to, png_byte*, std::size_t n) { *static_cast<std::size_t*>(png_get_io_ptr(to)) += n; },
        nullptr);
    png_set_compression_level(png, 9);
    png_set_filter(png, 0, PNG_ALL_FILTERS);
    png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (std::size_t y = 0; y < std::size_t(height); ++y)
        png_write_row(png, &rgb[y * std::size_t(width) * 3]);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return length;
}

std::size_t libjpeg(const Image& image) {
    const auto& rgba = std::get<0>(image.rgba);
    jpeg_compress_struct jpeg;
    jpeg_error_mgr errors;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* out = nullptr;
    unsigned long length = 0;
    jpeg_mem_dest(&jpeg, &out, &length);
    jpeg.image_width = JDIMENSION(image.width);
    jpeg.image_height = JDIMENSION(image.height);
    jpeg.input_components = 4;
    jpeg.in_color_space = JCS_EXT_RGBA;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    for (int i = 0; i < jpeg.num_components; ++i)  // 4:4:4, as ours
        jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        auto* row =
            const_cast<unsigned char*>(&rgba[std::size_t(jpeg.next_scanline) * std::size_t(image.width) * 4]);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::free(out);
    return length;
}

void libjpeg_open(std::span<const std::byte> file) {
    jpeg_decompress_struct jpeg;
    jpeg_error_mgr errors;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&jpeg);
    const std::size_t row_bytes = std::size_t(jpeg.output_width) * 4;
    std::vector<unsigned char> rgba(row_bytes * jpeg.output_height);
    while (jpeg.output_scanline < jpeg.output_height) {
        unsigned char* row = &rgba[row_bytes * jpeg.output_scanline];
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    jpeg_destroy_decompress(&jpeg);
}

void spng_open(std::span<const std::byte> file) {
    spng_ctx* spng = spng_ctx_new(0);
    spng_set_png_buffer(spng, file.data(), file.size());
    std::size_t size = 0;
    spng_decoded_image_size(spng, SPNG_FMT_RGBA8, &size);
    std::vector<unsigned char> rgba(size);
    spng_decode_image(spng, rgba.data(), size, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS);
    spng_ctx_free(spng);
}

}  // namespace probewarp::bench
