// Text inside XML.
#include "write/xml.h"

// The length of the UTF-8 sequence at *at when it is one that XML allows, else 0.
static size_t sound_sequence(const unsigned char *at)
{
    if (at[0] < 0x80) return at[0] >= 0x20 || at[0] == '\t' || at[0] == '\n';
    size_t length = at[0] >= 0xf0 ? 4 : at[0] >= 0xe0 ? 3 : 2;
    if (at[0] < 0xc2 || at[0] > 0xf4) return 0;
    uint32_t code = at[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((at[i] & 0xc0) != 0x80) return 0;
        code = code << 6 | (at[i] & 0x3f);
    }
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    bool allowed = code >= least[length] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff) &&
                   code != 0xfffe && code != 0xffff;
    return allowed ? length : 0;
}

jali_status xml_text(jali_context *ctx, const char *text, jali_bytes *bytes)
{
    jali_status status = JALI_OK;
    while (*text) {
        size_t length = sound_sequence((const unsigned char *)text);
        const char *instead = length == 0    ? "?"
                              : *text == '&' ? "&amp;"
                              : *text == '<' ? "&lt;"
                              : *text == '>' ? "&gt;"
                              : *text == '"' ? "&quot;"
                                             : NULL;
        if (instead)
            TRY(bytes_append(ctx, bytes, instead, strlen(instead)));
        else
            TRY(bytes_append(ctx, bytes, text, length));
        text += MAX(length, (size_t)1);
    }
done:
    return status;
}
