#pragma once

#include "importer/site/site_import.h"

namespace patrol::importer {

/// Reads a MuJoCo model as a site: the model as it is, with its <include> files inserted and its meshes, textures and
/// height fields copied below meshes/ and textures/. Ground is decided by contact height. Throws InputError
/// "file:line: <element>: what" for files that are missing and for elements that are not supported.
ImportedSite read_mjcf_site(const SiteImportOptions& options);

}  // namespace patrol::importer
