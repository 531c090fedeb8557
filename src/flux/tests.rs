mod equilibrium;
mod identities;
mod lemma_17;
mod properties;
mod samples;
mod sectors;
mod wedges;
