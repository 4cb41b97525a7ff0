#include "bake/build_facts.h"

#include "gpu/backends.h"
#include "source_commit.h"
#include "tree/masks/masks.h"

#include <algorithm>

namespace surfelao {
namespace {

constexpr Library kLibraries[] = {
#include "libraries.inc"
};

constexpr BuildFacts kFacts = {SURFELAO_VERSION, SURFELAO_COMMIT, SURFELAO_BUILD_TYPE,
                               SURFELAO_COMPILER, kLibraries};

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text.append(text.empty() ? "" : ", ").append(word);
    return text.empty() ? "none" : text;
}

}  // namespace

const BuildFacts& build_facts()
{
    return kFacts;
}

InstructionSets instruction_sets()
{
    InstructionSets sets;
    for (const MaskKernelSet set :
         {MaskKernelSet::avx512, MaskKernelSet::avx2, MaskKernelSet::portable}) {
        const std::string name(name_of(set));  // of the portable one where it is not compiled in
        if (std::find(sets.compiled.begin(), sets.compiled.end(), name) == sets.compiled.end())
            sets.compiled.push_back(name);
    }
    for (const MaskKernelSet set : available_mask_kernels())
        sets.usable.emplace_back(name_of(set));
    return sets;
}

std::string version_text()
{
    const BuildFacts& facts = build_facts();
    std::string text = "surfelao " + std::string(facts.version);
    if (!facts.commit.empty())
        text.append(" (").append(facts.commit).append(")");
    text.append("\nbuild         ").append(facts.build_type).append(", ").append(facts.compiler);
    const InstructionSets sets = instruction_sets();
    text += "\ninstructions  " + joined(sets.compiled) + "; here " + joined(sets.usable);
    text += "\nOpenGL        EGL, OSMesa; here " + joined(installed_gl_backends());
    std::vector<std::string> libraries;
    for (const auto& [name, version] : facts.libraries)
        libraries.push_back(std::string(name) + ' ' + std::string(version));
    return text + "\nlibraries     " + joined(libraries);
}

}  // namespace surfelao
