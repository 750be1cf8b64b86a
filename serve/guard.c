// Who may ask: this machine's own page, and nobody who only knows the port.
//
// Against: a page of another origin, by Origin, Sec-Fetch-Site and a token in a header of our own (a browser
// asks
//          first whether it may send that, and is never told yes); a name that is made to point to 127.0.0.1
//          (DNS rebinding), by Host; other users of this machine, by the token.
// Checked: tests/test_serve.c.
#include "guard.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { ORIGIN_BYTES = 64 };

typedef struct look {
    const server *s;
    int32_t hosts;
    bool host_wrong, origin_wrong, site_wrong;
} look;

// "127.0.0.1:PORT" or "localhost:PORT".
static bool is_ours(const server *s, const char *host)
{
    char own[ORIGIN_BYTES], named[ORIGIN_BYTES];
    snprintf(own, sizeof own, "127.0.0.1:%d", s->port);
    snprintf(named, sizeof named, "localhost:%d", s->port);
    return strcmp(host, own) == 0 || strcasecmp(host, named) == 0;
}

static enum MHD_Result see(void *user, enum MHD_ValueKind kind, const char *key, const char *value)
{
    look *l = user;
    (void)kind;
    if (!value) value = "";
    if (strcasecmp(key, "Host") == 0) {
        l->hosts++;
        l->host_wrong |= !is_ours(l->s, value);
    } else if (strcasecmp(key, "Origin") == 0) {
        l->origin_wrong |= strncmp(value, "http://", 7) != 0 || !is_ours(l->s, value + 7);
    } else if (strcasecmp(key, "Sec-Fetch-Site") == 0) {
        l->site_wrong |= strcmp(value, "same-origin") != 0 && strcmp(value, "none") != 0;
    }
    return MHD_YES;
}

// The time it takes does not tell how much of it was right.
static bool same_secret(const char *secret, const char *given)
{
    unsigned differs = strlen(given) != strlen(secret);
    for (size_t i = 0, k = 0; secret[i]; i++) {
        differs |= (unsigned char)(secret[i] ^ given[k]);
        k += given[k] != 0;
    }
    return differs == 0;
}

const char *guard_refusal(const server *s, struct MHD_Connection *connection, bool api)
{
    look l = {.s = s};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, see, &l);
    if (l.hosts != 1 || l.host_wrong) return "the Host of this request is not this server's";
    if (l.origin_wrong) return "a page of another origin may ask nothing here";
    if (!api) return NULL;
    if (l.site_wrong) return "a page of another site may ask nothing here";
    const char *token = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "X-Jali-Token");
    if (!token || !same_secret(s->token, token))
        return "X-Jali-Token is missing or wrong; it stands in the address that jali serve has printed";
    return NULL;
}

void guard_headers(struct MHD_Response *response)
{
    static const char *const headers[][2] = {
        {"Content-Security-Policy",
         "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; font-src "
         "'self'; "
         "connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; "
         "frame-ancestors 'none'"},
        {"X-Content-Type-Options", "nosniff"},
        {"X-Frame-Options", "DENY"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cross-Origin-Embedder-Policy", "require-corp"},
        {"Permissions-Policy", "camera=(), microphone=(), geolocation=()"},
        {"Cache-Control", "no-store"},
    };
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        MHD_add_response_header(response, headers[i][0], headers[i][1]);
}
