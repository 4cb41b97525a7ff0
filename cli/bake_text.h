/// bake_text.h: what `bake` says on standard output of one result.
#pragma once

#include "bake/bake.h"

namespace surfelao {

void print_report(const BakeReport& report);

}  // namespace surfelao
