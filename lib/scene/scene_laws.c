/* scene/scene_laws.c: what a pair of kinds does beyond friction and restitution, from its JSON: each
   law is an object of its own, which takes the place of the one for all pairs. */
#include "scene/scene_read.h"

#include <string.h>

static int read_cohesion(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    l->cohesion = l->range = 0;
    return json_node_only(o, "force range") || json_node_need(&o, "force") ||
           json_node_number(json_node_key(&o, "force"), J_NOT_NEGATIVE, &l->cohesion) ||
           json_node_number(json_node_key(&o, "range"), J_NOT_NEGATIVE, &l->range);
}

static int read_capillary(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    l->volume = l->tension = l->wetting = 0;
    jnode angle = json_node_key(&o, "wetting");
    if (json_node_only(o, "volume tension wetting") || json_node_need(&o, "volume tension") ||
        json_node_number(json_node_key(&o, "volume"), J_NOT_NEGATIVE, &l->volume) ||
        json_node_number(json_node_key(&o, "tension"), J_NOT_NEGATIVE, &l->tension) ||
        json_node_number(angle, J_NOT_NEGATIVE, &l->wetting))
        return 1;
    if (l->wetting < M_PI / 2) return 0;
    return json_node_fault(angle,
                           "must be less than pi/2: a liquid that does not wet has no bridge");
}

static int read_rolling(jnode o, struct pair_law *l)
{
    if (!o.json) return 0;
    l->mu_r = l->mu_p = 0;
    return json_node_only(o, "mu_r mu_p") ||
           json_node_number(json_node_key(&o, "mu_r"), J_NOT_NEGATIVE, &l->mu_r) ||
           json_node_number(json_node_key(&o, "mu_p"), J_NOT_NEGATIVE, &l->mu_p);
}

/* t: of the scene, s */
static int read_adhesion(jnode o, double t, struct pair_law *l)
{
    bool forever = false;
    if (!o.json) return 0;
    l->eta = l->area = 0, l->beta = 1, l->made = t;
    if (json_node_only(o, "c_n c_t w eta area beta made forever") || json_node_need(&o, "c_n w") ||
        json_node_number(json_node_key(&o, "c_n"), J_POSITIVE, &l->cn))
        return 1;
    l->ct = l->cn;
    if (json_node_number(json_node_key(&o, "c_t"), J_NOT_NEGATIVE, &l->ct) ||
        json_node_number(json_node_key(&o, "w"), J_NOT_NEGATIVE, &l->w) ||
        json_node_number(json_node_key(&o, "eta"), J_NOT_NEGATIVE, &l->eta) ||
        json_node_number(json_node_key(&o, "area"), J_NOT_NEGATIVE, &l->area) ||
        json_node_number(json_node_key(&o, "beta"), J_UNIT, &l->beta) ||
        json_node_number(json_node_key(&o, "made"), J_ANY, &l->made) ||
        json_node_bool(json_node_key(&o, "forever"), &forever))
        return 1;
    l->forever = forever;
    if (forever && json_node_key(&o, "made").json)
        return json_node_fault(o, "bonds are made at a time or for ever: not both");
    return 0;
}

static int read_impact(jnode o, struct pair_law *l)
{
    const char *name = NULL;
    if (!o.json) return 0;
    if (json_node_text(o, &name)) return 1;
    l->impact = !strcmp(name, "newton") ? IMPACT_NEWTON : IMPACT_BOUNDED;
    if (l->impact == IMPACT_NEWTON || !strcmp(name, "bounded")) return 0;
    return json_node_fault(o, "needs \"newton\" or \"bounded\"");
}

int scene_read_laws(const jnode *o, double t, struct pair_law *l)
{
    return read_cohesion(json_node_key(o, "cohesion"), l) ||
           read_capillary(json_node_key(o, "capillary"), l) ||
           read_rolling(json_node_key(o, "rolling"), l) ||
           read_adhesion(json_node_key(o, "adhesion"), t, l) ||
           read_impact(json_node_key(o, "impact"), l);
}
