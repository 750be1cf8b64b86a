// The processes of jobs: started, fed, listened to, ended.
#ifndef SERVE_DISPATCH_H
#define SERVE_DISPATCH_H

#include "serve.h"

/// Look after all jobs until the context is cancelled; then end their processes. On the main thread: a
/// process ends with the thread that started it.
jali_status dispatch(jali_context *ctx, server *s);

#endif
