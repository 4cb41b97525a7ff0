// surfelao-import FILE: writes what assimp reads of a file as GLB to standard output.
//
// A program of its own because assimp fails on broken files in ways that end a process: whoever
// starts it sets limits of memory and time (files/foreign_io.h). Lines that begin with "note: " on
// standard error are told of the scene; on exit code 1 the last line is the reason.
#include "files/import/glb.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <assimp/Importer.hpp>

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

std::string assimp_version()
{
    return "assimp " + std::to_string(aiGetVersionMajor()) + "." +
           std::to_string(aiGetVersionMinor()) + "." + std::to_string(aiGetVersionPatch());
}

/// Leaves the reader of this extension alone: a file must not reach others by what it holds.
void keep_reader_of(const std::string& extension, Assimp::Importer& importer)
{
    const std::size_t kept = importer.GetImporterIndex(extension.c_str());
    Assimp::BaseImporter* const reader = importer.GetImporter(kept);
    if (!reader)
        throw std::runtime_error("it has no reader of " + extension);
    std::vector<Assimp::BaseImporter*> others;
    for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
        if (i != kept)
            others.push_back(importer.GetImporter(i));
    }
    for (Assimp::BaseImporter* const other : others) {
        importer.UnregisterLoader(other);
        delete other;
    }
}

/// What moves in the file and stands still here.
void note_what_rests(const aiScene& scene, std::vector<std::string>& notes)
{
    if (scene.mNumAnimations > 0)
        notes.push_back("animations are left out: " + std::to_string(scene.mNumAnimations));
    const std::span<aiMesh* const> meshes(scene.mMeshes, scene.mNumMeshes);
    const auto morphed =
        std::ranges::count_if(meshes, [](const aiMesh* mesh) { return mesh->mNumAnimMeshes > 0; });
    if (morphed > 0)
        notes.push_back("morph targets are left out, of meshes: " + std::to_string(morphed));
}

std::string import_as_glb(const std::filesystem::path& file, std::vector<std::string>& notes)
{
    Assimp::Importer importer;
    keep_reader_of(file.extension().string(), importer);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    const aiScene* const scene =
        importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                             aiProcess_SortByPType | aiProcess_TransformUVCoords);
    if (!scene) {
        const std::string reason = importer.GetErrorString();
        if (reason.find("bad_alloc") != std::string::npos)
            throw std::bad_alloc();  // which assimp has caught
        throw std::runtime_error(reason);
    }
    SourceFile source{file, file.extension().string().substr(1)};
    std::ranges::transform(source.format, source.format.begin(),
                           [](unsigned char letter) { return std::toupper(letter); });
    notes.push_back("read through " + assimp_version() + " (" + source.format + ")");
    note_what_rests(*scene, notes);
    return glb_of(*scene, source, notes);
}

/// False where it could not be written.
bool write_all(int descriptor, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = write(descriptor, bytes.data(), bytes.size());
        if (count <= 0)
            return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

int run(const char* file)
{
    // what assimp prints is no part of the result
    const int result = dup(STDOUT_FILENO);
    dup2(STDERR_FILENO, STDOUT_FILENO);
    std::vector<std::string> notes;
    const bool is_written = write_all(result, import_as_glb(file, notes));
    for (const std::string& note : notes)
        std::cerr << "note: " << note << '\n';
    if (!is_written)
        std::cerr << "the result could not be written\n";
    return is_written ? 0 : 1;
}

}  // namespace
}  // namespace surfelao

int main(int argument_count, char** arguments)
{
    if (argument_count != 2) {
        std::cerr << "surfelao-import FILE >RESULT.glb\n";
        return 2;
    }
    try {
        return surfelao::run(arguments[1]);
    } catch (const std::bad_alloc&) {
        std::cerr << "not enough memory\n";
    } catch (const std::exception& error) {
        std::cerr << surfelao::assimp_version() << " cannot read it: " << error.what() << '\n';
    }
    return 1;
}
