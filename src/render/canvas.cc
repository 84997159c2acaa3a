#include "render/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <ft2build.h>
#include FT_FREETYPE_H

#include "core/error.h"

namespace patrol::render {
namespace {

std::filesystem::path font_file(bool is_bold) {
  const char* name = is_bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
  constexpr std::array kFolders = {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                                   "/usr/share/fonts/dejavu", "/usr/share/fonts/TTF"};
  for (const char* folder : kFolders) {
    std::filesystem::path file = std::filesystem::path(folder) / name;
    if (std::filesystem::exists(file)) return file;
  }
  throw InputError(std::string(name) + " is not installed (package fonts-dejavu-core): required by replay");
}

/// Decodes the character at `at` of valid UTF-8 and advances `at` past it.
char32_t next_character(const std::string& text, std::size_t& at) {
  const auto first = static_cast<unsigned char>(text[at++]);
  const int following = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  char32_t character = following == 0 ? first : first & (0x3fu >> following);
  for (int i = 0; i < following && at < text.size(); ++i) {
    character = (character << 6) | (static_cast<unsigned char>(text[at++]) & 0x3fu);
  }
  return character;
}

/// Calls `shade(x, y, distance)` for the pixels around a line segment.
template <typename Shade>
void around_segment(const Frame& frame, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double reach, Shade shade) {
  const Eigen::Vector2d low = a.cwiseMin(b).array() - reach, high = a.cwiseMax(b).array() + reach;
  if (!(high.x() >= 0.0 && high.y() >= 0.0 && low.x() <= frame.width() && low.y() <= frame.height())) return;
  const int left = static_cast<int>(std::max(0.0, low.x())), top = static_cast<int>(std::max(0.0, low.y()));
  const int right = static_cast<int>(std::min(frame.width() - 1.0, high.x()));
  const int bottom = static_cast<int>(std::min(frame.height() - 1.0, high.y()));
  const Eigen::Vector2d along = b - a;
  const double squared = std::max(along.squaredNorm(), 1e-12);
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      const double t = std::clamp((p - a).dot(along) / squared, 0.0, 1.0);
      shade(x, y, (p - a - t * along).norm());
    }
  }
}

}  // namespace

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Face() = default;
  ~Face() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
};

Font::Font(int height_px, bool is_bold) : face_(std::make_unique<Face>()), height_px_(height_px) {
  const std::filesystem::path file = font_file(is_bold);
  if (FT_Init_FreeType(&face_->library) != 0 || FT_New_Face(face_->library, file.c_str(), 0, &face_->face) != 0 ||
      FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(height_px)) != 0) {
    throw std::runtime_error(file.string() + ": FreeType cannot use this font");
  }
}

Font::~Font() = default;

int Font::draw(Frame& frame, int left, int baseline, const std::string& text, const Brush& brush) {
  for (std::size_t at = 0; at < text.size();) {
    if (FT_Load_Char(face_->face, next_character(text, at), FT_LOAD_RENDER) != 0) continue;
    const auto* const glyph = face_->face->glyph;
    const FT_Bitmap& bitmap = glyph->bitmap;
    for (int row = 0; row < static_cast<int>(bitmap.rows); ++row) {
      for (int col = 0; col < static_cast<int>(bitmap.width); ++col) {
        const int x = left + glyph->bitmap_left + col, y = baseline - glyph->bitmap_top + row;
        if (!frame.contains(x, y)) continue;
        const double coverage = bitmap.buffer[row * bitmap.pitch + col] / 255.0;
        frame.at(x, y) = blend(frame.at(x, y), brush.color, coverage * brush.opacity);
      }
    }
    left += static_cast<int>(glyph->advance.x >> 6);
  }
  return left;
}

int Font::width_px(const std::string& text) {
  int width = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (FT_Load_Char(face_->face, next_character(text, at), FT_LOAD_DEFAULT) != 0) continue;
    width += static_cast<int>(face_->face->glyph->advance.x >> 6);
  }
  return width;
}

std::string Font::fitted(const std::string& text, int width) {
  if (width_px(text) <= width) return text;
  std::string cut;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = at;
    next_character(text, at);
    if (width_px(cut + text.substr(begin, at - begin) + "…") > width) break;
    cut += text.substr(begin, at - begin);
  }
  return cut + "…";
}

void fill_rectangle(Frame& frame, int left, int top, int width, int height, const Brush& brush) {
  for (int y = std::max(0, top); y < std::min(frame.height(), top + height); ++y) {
    for (int x = std::max(0, left); x < std::min(frame.width(), left + width); ++x) {
      frame.at(x, y) = blend(frame.at(x, y), brush.color, brush.opacity);
    }
  }
}

void draw_line(Frame& frame, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_px,
               const Brush& brush) {
  const double reach = 0.5 * width_px + 0.5;
  around_segment(frame, from, to, reach, [&](int x, int y, double distance) {
    const double coverage = std::clamp(reach - distance, 0.0, 1.0);
    if (coverage > 0.0) frame.at(x, y) = blend(frame.at(x, y), brush.color, coverage * brush.opacity);
  });
}

void draw_disc(Frame& frame, const Eigen::Vector2d& center, double radius_px, const Brush& brush) {
  draw_line(frame, center, center, 2.0 * radius_px, brush);
}

void paste(Frame& frame, int left, int top, const Frame& picture) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (frame.contains(left + x, top + y)) frame.at(left + x, top + y) = picture.at(x, y);
    }
  }
}

}  // namespace patrol::render
