#include "importer/site/mjcf_site.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "importer/site/mjcf_options.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"
#include "io/files/xml_problem.h"

namespace patrol::importer {
namespace {

using tinyxml2::XMLElement;

std::string text_of(const XMLElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text == nullptr ? "" : text;
}

/// Attributes that name a file, and the folder of the copy.
struct FileAttribute {
  std::string_view element;
  const char* attribute;
  const char* folder;
};

constexpr std::array kFileAttributes = std::to_array<FileAttribute>({
    {"mesh", "file", "meshes"},
    {"skin", "file", "meshes"},
    {"hfield", "file", "meshes"},
    {"texture", "file", "textures"},
    {"texture", "fileright", "textures"},
    {"texture", "fileleft", "textures"},
    {"texture", "fileup", "textures"},
    {"texture", "filedown", "textures"},
    {"texture", "filefront", "textures"},
    {"texture", "fileback", "textures"},
});

/// Text of a MuJoCo model with its files.
class MjcfCopy {
 public:
  MjcfCopy(const std::filesystem::path& file, ImportedSite& site) : file_(file), site_(site) {}

  std::string text() {
    tinyxml2::XMLDocument document;
    parse(file_, document);
    XMLElement& root = *document.RootElement();
    if (std::string_view(root.Name()) != "mujoco")
      throw InputError(fmt::format("{}:{}: <{}>: must be <mujoco>", file_.string(), root.GetLineNum(), root.Name()));
    use_options_of_sites(file_, root);
    insert_includes(root, file_);
    read_folders(root);
    copy_files(root);
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    return printer.CStr();
  }

 private:
  [[noreturn]] void fail(const XMLElement& element, const std::filesystem::path& file, const std::string& what) const {
    throw InputError(
        fmt::format("{}:{}: <{}>: {}", file.string(), element.GetLineNum(), element.Name(), io::on_one_line(what)));
  }

  static void parse(const std::filesystem::path& file, tinyxml2::XMLDocument& document) {
    const std::string text = io::load_text(file);
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
      throw input_error(file.string(), document.ErrorLineNum(), "not XML: " + io::xml_problem(document));
  }

  void use_options_of_sites(const std::filesystem::path& file, XMLElement& root) {
    for (Assumption& row : replace_options(file, root)) site_.assumptions.push_back(std::move(row));
  }

  /// Replaces the includes below an element of `file` by the content of the files, which are relative to the model.
  void insert_includes(XMLElement& parent, const std::filesystem::path& file) {
    for (XMLElement* child = parent.FirstChildElement(); child != nullptr;) {
      XMLElement* next = child->NextSiblingElement();
      if (std::string_view(child->Name()) != "include") {
        insert_includes(*child, file);
        child = next;
        continue;
      }
      const std::string name = text_of(*child, "file");
      const std::filesystem::path included = file_.parent_path() / name;
      std::error_code error;
      if (!std::filesystem::is_regular_file(included, error)) fail(*child, file, name + ": file not found");
      if (!included_.insert(std::filesystem::weakly_canonical(included)).second)
        fail(*child, file, name + ": is included twice");
      tinyxml2::XMLDocument document;
      parse(included, document);
      use_options_of_sites(included, *document.RootElement());
      insert_includes(*document.RootElement(), included);
      tinyxml2::XMLNode* last = child;
      for (const tinyxml2::XMLNode* node = document.RootElement()->FirstChild(); node != nullptr;
           node = node->NextSibling())
        last = parent.InsertAfterChild(last, node->DeepClone(parent.GetDocument()));
      parent.DeleteChild(child);
      child = next;
    }
  }

  /// Reads the folders of the compiler element, and removes them: the copies have folders of their own.
  void read_folders(XMLElement& root) {
    for (XMLElement* compiler = root.FirstChildElement("compiler"); compiler != nullptr;
         compiler = compiler->NextSiblingElement("compiler")) {
      for (const char* attribute : {"assetdir", "meshdir", "texturedir"}) {
        if (compiler->Attribute(attribute) == nullptr) continue;
        const std::string folder = text_of(*compiler, attribute);
        if (std::string_view(attribute) != "texturedir") mesh_folder_ = folder;
        if (std::string_view(attribute) != "meshdir") texture_folder_ = folder;
        compiler->DeleteAttribute(attribute);
      }
      strips_path_ |= text_of(*compiler, "strippath") == "true";
      compiler->DeleteAttribute("strippath");
    }
  }

  void copy_files(XMLElement& root) {
    for (XMLElement* asset = root.FirstChildElement("asset"); asset != nullptr;
         asset = asset->NextSiblingElement("asset")) {
      for (XMLElement* child = asset->FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        if (std::string_view(child->Name()) == "model") fail(*child, file_, "attached models are not supported");
        for (const FileAttribute& entry : kFileAttributes) {
          if (entry.element == child->Name() && child->Attribute(entry.attribute) != nullptr) copy(*child, entry);
        }
      }
    }
  }

  void copy(XMLElement& element, const FileAttribute& entry) {
    std::string name = text_of(element, entry.attribute);
    if (strips_path_) name = std::filesystem::path(name).filename().string();
    const bool is_texture = entry.element == "texture";
    const std::filesystem::path source = file_.parent_path() / (is_texture ? texture_folder_ : mesh_folder_) / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(source, error)) fail(element, file_, source.string() + ": file not found");
    if (element.Attribute("name") == nullptr && std::string_view(entry.attribute) == "file")
      element.SetAttribute("name", std::filesystem::path(name).stem().string().c_str());
    const std::string copied = copy_of(source, entry.folder);
    element.SetAttribute(entry.attribute, copied.c_str());
  }

  /// Returns the path of the copy below the folder of the site.
  std::string copy_of(const std::filesystem::path& source, const std::string& folder) {
    const std::string key = folder + "|" + std::filesystem::weakly_canonical(source).string();
    if (const auto found = copies_.find(key); found != copies_.end()) return found->second;
    std::string path = fmt::format("{}/{}", folder, source.filename().string());
    for (int i = 2; !paths_.insert(path).second; ++i)
      path = fmt::format("{}/{}_{}{}", folder, source.stem().string(), i, source.extension().string());
    site_.files.push_back({.path = path, .content = io::load_text(source)});
    copies_[key] = path;
    return path;
  }

  std::filesystem::path file_;
  ImportedSite& site_;
  std::filesystem::path mesh_folder_, texture_folder_;
  bool strips_path_ = false;
  std::set<std::filesystem::path> included_;
  std::map<std::string, std::string> copies_;  ///< paths of copied files, by folder and source
  std::set<std::string> paths_;
};

}  // namespace

ImportedSite read_mjcf_site(const SiteImportOptions& options) {
  ImportedSite site{.name = options.name, .source = options.file.string()};
  site.mjcf = MjcfCopy(options.file, site).text();
  site.assumptions.push_back(
      {"ground",
       fmt::format("contacts from above up to {:g} m above the robot's lowest contact, and no geom by name",
                   site.ground.max_step_m),
       "ground in " + options.name + ".yaml"});
  site.assumptions.push_back(
      {"groups", "geoms of groups 0 and 1 are seen by cameras, 0 and 2 by lidars, 4 and 5 are those of robots",
       "group"});
  return site;
}

}  // namespace patrol::importer
