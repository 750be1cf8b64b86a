// Uploads: kept until there is no room, the one not used for longest goes first.
//
// A job holds what it reads, so an upload may go while a job of it waits; its bytes count until the job ends.
#include "store.h"

#include <stdio.h>
#include <string.h>

static void drop(upload *u)
{
    blob_let_go(u->bytes);
    *u = (upload){0};
}

// The one to go; NULL: none is kept. A free place comes first.
static upload *oldest(server *s)
{
    upload *found = &s->upload[0];
    for (int32_t i = 0; i < MOST_UPLOADS; i++) {
        if (!s->upload[i].bytes) continue;
        if (!found->bytes || s->upload[i].used < found->used) found = &s->upload[i];
    }
    return found->bytes ? found : NULL;
}

blob *store_room(server *s, size_t bytes)
{
    blob *room = blob_create(&s->upload_budget, bytes);
    pthread_mutex_lock(&s->lock);
    for (upload *u; !room && bytes <= s->upload_budget.most && (u = oldest(s));) {
        drop(u);
        room = blob_create(&s->upload_budget, bytes);
    }
    pthread_mutex_unlock(&s->lock);
    return room;
}

bool name_is_fit(const char *name)
{
    static const char *const taken[] = {"", "-", "model.mesh", "printer.json", "edits.json"};
    json_t *valid = json_string(name); // UTF-8
    bool fit = valid && strlen(name) <= MOST_NAME_BYTES;
    json_decref(valid);
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++) fit = fit && strcmp(name, taken[i]) != 0;
    for (const char *c = name; *c; c++) fit = fit && (unsigned char)*c >= 32 && *c != '/' && *c != 127;
    return fit;
}

bool store_keep(server *s, blob *bytes, const char *name, char id[TOKEN_BYTES])
{
    upload *place = NULL;
    if (!random_id(id)) return false;
    pthread_mutex_lock(&s->lock);
    for (int32_t i = 0; i < MOST_UPLOADS && !place; i++)
        if (!s->upload[i].bytes) place = &s->upload[i];
    if (!place) {
        place = oldest(s);
        drop(place);
    }
    *place = (upload){.bytes = bytes, .used = ++s->clock};
    memcpy(place->id, id, TOKEN_BYTES);
    snprintf(place->name, sizeof place->name, "%s", name_is_fit(name) ? name : "picture");
    pthread_mutex_unlock(&s->lock);
    return true;
}

blob *store_find(server *s, const char *id, char name[MOST_NAME_BYTES + 1])
{
    blob *found = NULL;
    pthread_mutex_lock(&s->lock);
    for (int32_t i = 0; i < MOST_UPLOADS && !found; i++) {
        upload *u = &s->upload[i];
        if (!u->bytes || strcmp(u->id, id) != 0) continue;
        u->used = ++s->clock;
        memcpy(name, u->name, sizeof u->name);
        found = blob_hold(u->bytes);
    }
    pthread_mutex_unlock(&s->lock);
    return found;
}

void store_free(server *s)
{
    for (int32_t i = 0; i < MOST_UPLOADS; i++) drop(&s->upload[i]);
}
