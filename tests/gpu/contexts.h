/// contexts.h: the context that tests draw with.
#pragma once

#include "gpu/context.h"

namespace surfelao {

/// Software, the same pixels everywhere, made once per test program; current in the calling thread.
inline const GlContext& test_context()
{
    static const GlContext context = GlContext::create(GlBackend::osmesa);
    context.make_current();
    return context;
}

}  // namespace surfelao
