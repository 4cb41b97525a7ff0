#!/usr/bin/env bash
# What becomes of the odd and bad files of Debian's package assimp-testmodels, as the table in
# docs/readers.md:
#
#     odd_files.sh SURFELAO           prints it
#     odd_files.sh SURFELAO --check   exit 1 where docs/readers.md says something else
#
# Every file is baked. A fault, which ends with exit 1: neither exit code 0 nor 1, a file that is
# left after a refusal, a refusal that is not one sentence beginning with the file's name, a result
# that cannot be read again. Exit 77: the package is not installed.
set -euo pipefail

surfelao=$(realpath "$1")
docs=$(dirname "$(realpath "$0")")/../docs/readers.md
models=/usr/share/assimp/models
[ -d "$models/glTF2" ] || { echo "assimp-testmodels is not installed"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$models"

declare -A odd=(
    [OBJ/box_longline.obj]="a face of 936 corners on one line"
    [OBJ/box_without_lineending.obj]="no newline at the end"
    [OBJ/concave_polygon.obj]="one concave face of 66 corners"
    [OBJ/space_in_material_name.obj]="one concave face of 66 corners"
    [OBJ/cube_with_vertexcolors.obj]="colours behind the coordinates"
    [OBJ/cube_with_vertexcolors_uni.obj]="colours behind the coordinates"
    [OBJ/multiple_spaces.obj]="an unused vertex"
    [OBJ/testmixed.obj]="points and lines beside faces"
    [PLY/Wuson.ply]="a comment without the word \"comment\""
    [STL/triangle_with_empty_solid.stl]="a solid without facets"
    [STL/triangle_with_two_solids.stl]="two solids"
    [glTF2/BoxBadNormals-glTF-Binary/BoxBadNormals.glb]="normals that are not of unit length"
    [glTF2/IncorrectVertexArrays/Cube.gltf]="35 corners where 36 would be whole triangles"
    [glTF2/wrongTypes/badExtension.gltf]="wrong types where no geometry is"
    [glTF2/wrongTypes/badNumber.gltf]="wrong types where no geometry is"
    [glTF2/wrongTypes/badObject.gltf]="wrong types where no geometry is"
    [glTF2/wrongTypes/badString.gltf]="wrong types where no geometry is"
    [glTF2/wrongTypes/badUint.gltf]="wrong types where no geometry is"
    [invalid/malformed2.obj]="a face without corners"
    [glTF2/simple_skin/simple_skin.gltf]="a skin: its default pose"
    [glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf]="morph targets: the default weights"
)

faults=0
fault() {
    echo "odd_files.sh: $1" >&2
    faults=1
}

baked=$work/baked.md
refused=$work/refused.md
: >"$baked" >"$refused"
while read -r file; do
    out=$work/out
    rm -rf "$out" "$work/again"
    mkdir "$out" "$work/again"
    code=0
    said=$("$surfelao" bake "$file" -o "$out" --quality draft 2>"$work/err") || code=$?
    case $code in
    0)
        counts=$(sed -nE 's/^ *([0-9]+) vertices, ([0-9]+) triangle.*/\1 | \2/p;
            s/^ *([0-9]+) points?,.*/\1 | a cloud/p' <<<"$said")
        [ -n "$counts" ] || fault "$file: baked, but said nothing of it"
        # not info, which looks for gaps with rays
        "$surfelao" bake "$out"/* -o "$work/again" --quality draft >/dev/null || fault "$file: its result cannot be read again"
        echo "| $file | $counts | ${odd[$file]:-} |" >>"$baked"
        ;;
    1)
        sentence=$(cat "$work/err")
        case $sentence in
        *$'\n'* | "") fault "$file: refused in more or less than one line: $sentence" ;;
        "surfelao: $file: "*) ;;
        *) fault "$file: is not named in its refusal: $sentence" ;;
        esac
        [ -z "$(ls -A "$out")" ] || fault "$file: refused, but left $(ls -A "$out")"
        echo "| $file | ${sentence#"surfelao: $file: "} |" >>"$refused"
        ;;
    *) fault "$file: exit code $code" ;;
    esac
done < <(find OBJ PLY OFF STL glTF2 glTF invalid -type f -regextype posix-extended \
    -iregex '.*\.(obj|ply|off|stl|gltf|glb)' | LC_ALL=C sort)

{
    echo "Baked, $(wc -l <"$baked") files, with vertices and triangles (polygons are cut into as many"
    echo "triangles as corners less two):"
    echo
    echo "| file | vertices | triangles | what is odd |"
    echo "|---|---|---|---|"
    cat "$baked"
    echo
    echo "Refused, $(wc -l <"$refused") files, each with the whole sentence behind the file's name:"
    echo
    echo "| file | sentence |"
    echo "|---|---|"
    cat "$refused"
} >"$work/table.md"

if [ "${2:-}" = --check ]; then
    sed -n '/<!-- figures odd_files -->/,/<!-- end -->/p' "$docs" | sed '1d;$d' >"$work/docs.md"
    diff "$work/docs.md" "$work/table.md" || fault "docs/readers.md is not up to date (above: <)"
else
    cat "$work/table.md"
fi
exit $faults
