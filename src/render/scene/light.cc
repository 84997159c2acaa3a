#include "render/scene/light.h"

#include <cmath>
#include <span>

namespace patrol::render {
namespace {

void dim(std::span<float> values, double scale) {
  for (float& value : values) value *= static_cast<float>(scale);
}

void dim_sky(mjModel& view, double scale) {
  for (int texture = 0; texture < view.ntex; ++texture) {
    if (view.tex_type[texture] != mjTEXTURE_SKYBOX) continue;
    const auto size = static_cast<std::size_t>(view.tex_width[texture]) *
                      static_cast<std::size_t>(view.tex_height[texture]) *
                      static_cast<std::size_t>(view.tex_nchannel[texture]);
    for (mjtByte& value : std::span(view.tex_data + view.tex_adr[texture], size)) {
      value = static_cast<mjtByte>(std::lround(scale * value));
    }
  }
}

}  // namespace

void set_light(mjModel& view, const LightSettings& light) {
  constexpr double kGamma = 2.2;
  if (light.intensity == 1.0) return;
  const double scale = std::pow(light.intensity, 1.0 / kGamma);
  const auto num_lights = static_cast<std::size_t>(view.nlight);
  for (float* light_of : {view.light_ambient, view.light_diffuse, view.light_specular})
    dim({light_of, 3 * num_lights}, scale);
  for (float* light_of : {view.vis.headlight.ambient, view.vis.headlight.diffuse, view.vis.headlight.specular})
    dim({light_of, 3}, scale);
  dim({view.mat_emission, static_cast<std::size_t>(view.nmat)}, scale);
  dim({view.vis.rgba.fog, 3}, scale);
  dim_sky(view, scale);
}

}  // namespace patrol::render
