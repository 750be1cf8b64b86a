// Uploads: kept until there is no room, the one not used for longest goes first.
#ifndef SERVE_STORE_H
#define SERVE_STORE_H

#include "serve.h"

/// Can a picture be called so in sentences and titles? It is no path, and not what a worker's other files are
/// called.
bool name_is_fit(const char *name);

/// Room for an upload of so many bytes; others may have to go for it. NULL: there is none, even so.
blob *store_room(server *s, size_t bytes);

/// Keep an upload (it is taken). False: no randomness.
///   in     name   of its file; what is not fit for one becomes "picture"
bool store_keep(server *s, blob *bytes, const char *name, char id[TOKEN_BYTES]);

/// Hold an upload; NULL: there is none of that id.
///   out    name   of its file
blob *store_find(server *s, const char *id, char name[MOST_NAME_BYTES + 1]);

void store_free(server *s);

#endif
