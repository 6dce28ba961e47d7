/// Reads and writes PNG files through libpng. libpng reports errors by longjmp, so it is called only from functions
/// whose locals need no destructor; their callers own the buffers.
#include "fase/atlas/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <optional>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"

namespace fase::atlas {
namespace {

/// The state that libpng's callbacks share: input, output and the error message.
struct PngIo {
    const std::byte* next = nullptr;
    std::size_t left = 0, size = 0;
    std::vector<std::byte>* out = nullptr;
    bool no_memory = false;
    char message[160] = {};
    std::jmp_buf back;
};

void set_message(PngIo& io, const char* text) { std::snprintf(io.message, sizeof io.message, "%s", text); }

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
    auto& io = *static_cast<PngIo*>(png_get_error_ptr(png));
    set_message(io, text);
    std::longjmp(io.back, 1);
}
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, std::size_t count) {
    auto& io = *static_cast<PngIo*>(png_get_io_ptr(png));
    if (count > io.left) png_error(png, "the file ends too early");
    std::memcpy(to, io.next, count);
    io.next += count;
    io.left -= count;
}

/// Appends to the output; returns false if memory runs out. Only this function changes the vector, so that no longjmp
/// interrupts a reallocation.
bool append(PngIo& io, const png_byte* from, std::size_t count) noexcept {
    try {
        const auto* bytes = reinterpret_cast<const std::byte*>(from);
        io.out->insert(io.out->end(), bytes, bytes + count);
        return true;
    } catch (...) {
        io.no_memory = true;
        return false;
    }
}
void on_write(png_structp png, png_bytep from, std::size_t count) {
    if (!append(*static_cast<PngIo*>(png_get_io_ptr(png)), from, count)) png_error(png, "not enough memory");
}
void on_flush(png_structp) {}

/// Owns both structures of libpng.
struct Handles {
    png_structp png = nullptr;
    png_infop info = nullptr;
    bool reads = true;
    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles() {
        if (reads) {
            png_destroy_read_struct(&png, &info, nullptr);
        } else {
            png_destroy_write_struct(&png, &info);
        }
    }
};

struct Header {
    png_uint_32 width = 0, height = 0;
    int depth = 0, kind = 0, interlaced = 0;
    int colours = 0;
    std::array<std::array<std::uint8_t, 4>, 256> palette = {};
};

/// Reads everything before the pixels and requests rows of RGBA or of palette indices.
bool read_header(png_structp png, png_infop info, PngIo& io, Header& header) {
    if (setjmp(io.back) != 0) return false;
    png_set_read_fn(png, &io, on_read);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_user_limits(png, 0x7fffffff, 0x7fffffff);  // read_png() checks max_pixels instead
    // Texts, profiles and the like are not read: a few bytes of them may expand to gigabytes.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_chunk_malloc_max(png, io.size);
    png_read_info(png, info);
    png_get_IHDR(png, info, &header.width, &header.height, &header.depth, &header.kind, &header.interlaced, nullptr,
                 nullptr);
    if (header.kind == PNG_COLOR_TYPE_PALETTE) {
        png_colorp colours = nullptr;
        png_bytep alphas = nullptr;
        int alpha_count = 0;
        if (png_get_PLTE(png, info, &colours, &header.colours) == 0) png_error(png, "no palette");
        if (png_get_tRNS(png, info, &alphas, &alpha_count, nullptr) == 0) alpha_count = 0;
        for (int i = 0; i < header.colours && i < 256; ++i)
            header.palette[static_cast<std::size_t>(i)] = {colours[i].red, colours[i].green, colours[i].blue,
                                                           i < alpha_count ? alphas[i] : png_byte{255}};
        png_set_packing(png);
    } else {
        png_set_expand(png);
        png_set_scale_16(png);
        png_set_gray_to_rgb(png);
        png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
    }
    return true;
}

/// Reads the pixels into contiguous rows, then the end of the file.
bool read_rows(png_structp png, png_infop info, PngIo& io, std::uint8_t* pixels, std::size_t row_size,
               png_uint_32 height) {
    if (setjmp(io.back) != 0) return false;
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != row_size) png_error(png, "rows of an unexpected size");
    for (int pass = 0; pass < passes; ++pass)
        for (png_uint_32 y = 0; y < height; ++y) png_read_row(png, pixels + y * row_size, nullptr);
    png_read_end(png, nullptr);
    return true;
}

/// Checks that every chunk lies within the file, so that libpng allocates and reads no more than there is. Returns the
/// offset of the first one that does not.
std::optional<std::size_t> chunk_past_end(std::span<const std::byte> bytes) {
    constexpr std::size_t frame = 12;  // length, name and checksum
    for (std::size_t at = 8; at < bytes.size();) {
        if (bytes.size() - at < frame) return at;
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::size_t>(bytes[at + i]);
        if (length > bytes.size() - at - frame) return at;
        if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return std::nullopt;  // nothing is read beyond
        at += frame + length;
    }
    return bytes.size();
}

bool write_all(png_structp png, png_infop info, PngIo& io, const Image& image) {
    if (setjmp(io.back) != 0) return false;
    png_set_write_fn(png, &io, on_write, on_flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.size.width), static_cast<png_uint_32>(image.size.height), 8,
                 PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < image.size.height; ++y) png_write_row(png, image.at(0, y));
    png_write_end(png, info);
    return true;
}

}  // namespace

Result<Image> read_png(std::span<const std::byte> bytes, const std::string& where) {
    const FileKind kind = kind_of(bytes);
    if (kind == FileKind::Other)
        return Error{Status::Format, detail::at_byte(where, 0), "found no PNG signature; expected a PNG image", {}};
    if (kind != FileKind::Png) return wrong_kind(where, kind, "a PNG image");
    PngIo io;
    io.next = bytes.data();
    io.left = io.size = bytes.size();
    const auto refuse = [&](std::string problem) {
        return Error{Status::Format, detail::at_byte(where, io.size - io.left), std::move(problem), {}};
    };
    if (const auto at = chunk_past_end(bytes))
        return Error{Status::Format,
                     detail::at_byte(where, *at),
                     "found a broken PNG (the file ends inside a chunk, or without an IEND); expected a complete one",
                     {}};
    Handles handles;
    handles.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &io, on_error, on_warning);
    if (handles.png != nullptr) handles.info = png_create_info_struct(handles.png);
    if (handles.info == nullptr) return Error{Status::NoMemory, where, "not enough memory", {}};
    Header header;
    if (!read_header(handles.png, handles.info, io, header))
        return refuse(fmt::format("found a broken PNG ({}); expected a complete one", io.message));
    const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
    if (pixels > static_cast<std::uint64_t>(max_pixels))
        return refuse(fmt::format("image expands to {} x {} pixels; expected at most {} pixels", header.width,
                                  header.height, max_pixels));
    // Deflate expands one byte to at most 1032: reject a size that the file cannot contain before allocating it.
    const std::uint64_t channels = header.kind == PNG_COLOR_TYPE_RGB || header.kind == PNG_COLOR_TYPE_RGBA ? 3 : 1;
    const std::uint64_t min_bytes = pixels * channels * static_cast<std::uint64_t>(header.depth) / 8 / 1032;
    if (min_bytes > bytes.size())
        return refuse(fmt::format("found {} bytes; expected at least {} for {} x {} pixels", bytes.size(), min_bytes,
                                  header.width, header.height));
    Image image(Size{static_cast<int>(header.width), static_cast<int>(header.height)});
    const bool indexed = header.kind == PNG_COLOR_TYPE_PALETTE;
    std::vector<std::uint8_t> indices(indexed ? static_cast<std::size_t>(pixels) : 0);
    std::uint8_t* const rows = indexed ? indices.data() : image.pixels.data();
    const std::size_t row_size = std::size_t{header.width} * (indexed ? 1 : 4);
    if (!read_rows(handles.png, handles.info, io, rows, row_size, header.height))
        return refuse(fmt::format("found a broken PNG ({}); expected a complete one", io.message));
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= header.colours)
            return refuse(fmt::format("found palette index {} at pixel {}, {}; expected 0 to {}", indices[i],
                                      i % header.width, i / header.width, header.colours - 1));
        std::memcpy(image.pixels.data() + 4 * i, header.palette[indices[i]].data(), 4);
    }
    return image;
}

Result<Image> read_png_file(const std::string& path) {
    const Result<std::vector<std::byte>> bytes = read_file(path, std::size_t{1} << 30);
    if (!bytes) return bytes.error();
    return read_png(*bytes, path);
}

Result<std::vector<std::byte>> write_png(const Image& image) {
    if (image.size.width < 1 || image.size.height < 1)
        return Error{Status::BadArgument, "image", "found no pixels; expected at least one", {}};
    if (image.size.width > 65536 || image.size.height > 65536)
        return Error{
            Status::Capacity,
            "image",
            fmt::format("found {} x {} pixels; expected sides of at most 65536", image.size.width, image.size.height),
            {}};
    std::vector<std::byte> out;
    PngIo io;
    io.out = &out;
    Handles handles;
    handles.reads = false;
    handles.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &io, on_error, on_warning);
    if (handles.png != nullptr) handles.info = png_create_info_struct(handles.png);
    if (handles.info == nullptr) return Error{Status::NoMemory, "image", "not enough memory", {}};
    if (!write_all(handles.png, handles.info, io, image))
        return Error{io.no_memory ? Status::NoMemory : Status::Io,
                     "image",
                     fmt::format("cannot be written as PNG: {}", io.message),
                     {}};
    return out;
}

}  // namespace fase::atlas
