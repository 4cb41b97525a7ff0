#!/usr/bin/env bash
# Links the real models of two Debian packages into data/models/ (not committed; data/README.md says
# what they are), installing the packages when they are missing. Prints the folder.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

for package in assimp-testmodels glmark2-data; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed && continue
    if [ "$(id -u)" = 0 ]; then sudo=; else sudo=sudo; fi
    $sudo apt-get install -y -qq --no-install-recommends "$package" >/dev/null
done

mkdir -p "$here/models"
assimp=/usr/share/assimp/models
ln -sf /usr/share/glmark2/models/bunny.obj "$here/models/bunny.obj"
ln -sf $assimp/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb "$here/models/engine.glb"
# one shape in four formats
ln -sf $assimp/OBJ/WusonOBJ.obj "$here/models/wuson.obj"
ln -sf $assimp/PLY/Wuson.ply "$here/models/wuson.ply"
ln -sf $assimp/OFF/Wuson.off "$here/models/wuson.off"
ln -sf $assimp/STL/Wuson.stl "$here/models/wuson.stl"
echo "$here/models"
