#include <stdexcept>
#include <string_view>
#include <vector>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "core/error.h"
#include "core/shared_library.h"
#include "render/scene/gl_context.h"

namespace patrol::render {
namespace {

/// EGL library, loaded at run time. MuJoCo takes its OpenGL functions from EGL whenever EGL is in the process
/// (eglGetProcAddress before OSMesaGetProcAddress). A program linked with EGL could therefore never use OSMesa.
class EglLibrary {
 public:
  explicit EglLibrary(SharedLibrary::Scope scope) : library_("libEGL.so.1", scope) {}

  bool is_loaded() const { return library_.is_loaded(); }

  template <typename Function>
  Function function(const char* name) const {
    if (void* const found = library_.find(name)) return reinterpret_cast<Function>(found);
    const auto get = reinterpret_cast<decltype(&eglGetProcAddress)>(library_.find("eglGetProcAddress"));
    return reinterpret_cast<Function>(get(name));
  }

 private:
  SharedLibrary library_;
};

bool contains_word(const char* words, std::string_view word) {
  return words != nullptr && std::string_view(words).find(word) != std::string_view::npos;
}

std::vector<EGLDeviceEXT> graphics_cards(const EglLibrary& egl) {
  const auto query_devices = egl.function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_string = egl.function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  if (query_devices == nullptr || query_string == nullptr) return {};
  constexpr int kMaxDevices = 32;
  std::vector<EGLDeviceEXT> devices(kMaxDevices);
  EGLint num_devices = 0;
  if (query_devices(kMaxDevices, devices.data(), &num_devices) != EGL_TRUE) return {};
  devices.resize(static_cast<std::size_t>(num_devices));
  std::erase_if(devices, [&](EGLDeviceEXT device) {
    return contains_word(query_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  });
  return devices;
}

/// Opens and initializes a display, EGL_NO_DISPLAY on failure.
EGLDisplay open_display(const EglLibrary& egl, EGLenum platform, void* device) {
  const auto get_display = egl.function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) return EGL_NO_DISPLAY;
  EGLDisplay display = get_display(platform, device, nullptr);
  if (display == EGL_NO_DISPLAY) return display;
  return egl.function<decltype(&eglInitialize)>("eglInitialize")(display, nullptr, nullptr) == EGL_TRUE
             ? display
             : EGL_NO_DISPLAY;
}

EGLDisplay open_graphics_card(const EglLibrary& egl) {
  for (EGLDeviceEXT device : graphics_cards(egl)) {
    if (EGLDisplay display = open_display(egl, EGL_PLATFORM_DEVICE_EXT, device); display != EGL_NO_DISPLAY)
      return display;
  }
  return EGL_NO_DISPLAY;
}

class EglContext : public GlContext {
 public:
  explicit EglContext(const EglLibrary& egl) : egl_(egl), display_(open_graphics_card(egl)) {
    if (display_ == EGL_NO_DISPLAY) display_ = open_display(egl, EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
    if (display_ == EGL_NO_DISPLAY) throw std::runtime_error("EGL: no graphics card and no surfaceless display");
    constexpr EGLint kWanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint num_configs = 0;
    egl.function<decltype(&eglChooseConfig)>("eglChooseConfig")(display_, kWanted, &config, 1, &num_configs);
    if (num_configs < 1 || egl.function<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API) != EGL_TRUE) {
      throw std::runtime_error("EGL: no OpenGL support");
    }
    context_ = egl.function<decltype(&eglCreateContext)>("eglCreateContext")(display_, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) throw std::runtime_error("EGL: cannot create an OpenGL context");
  }
  ~EglContext() override {
    make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl_.function<decltype(&eglDestroyContext)>("eglDestroyContext")(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current() override {
    if (make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      throw std::runtime_error("EGL: cannot make the OpenGL context current without a surface");
    }
  }

 private:
  EglLibrary egl_;
  decltype(&eglMakeCurrent) make_current_ = egl_.function<decltype(&eglMakeCurrent)>("eglMakeCurrent");
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

bool has_graphics_card() {
  const EglLibrary egl(SharedLibrary::Scope::kLocal);
  return egl.is_loaded() && open_graphics_card(egl) != EGL_NO_DISPLAY;
}

std::unique_ptr<GlContext> make_egl_context() {
  const EglLibrary egl(SharedLibrary::Scope::kGlobal);
  if (!egl.is_loaded()) throw InputError("renderer = egl: libEGL.so.1 is not installed (package libegl1)");
  return std::make_unique<EglContext>(egl);
}

}  // namespace patrol::render
