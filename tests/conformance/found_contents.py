"""Contents of MESH that no encoder writes: found by drawing decisions at random, yet sound."""

from __future__ import annotations

FAR = bytes.fromhex(
    "09b8a50660000005fc000002c67b38eda41084ce2014a5368ee0b3ae00000000000000000540f7d7"
    "ecfb1ea22c32a7c935482126f306ce3e1efaf9299d484758a6abce8bb84617a322a507c2c5a7c4c3"
    "ec4234d4b8fc3f72d7d6475ca26ed897a7c8f2fc8178bc20941352952742f33eed07e2399ba2a058"
    "faf1f376ce8ca5ae0f51b102ea7edf1cab0fe1d67c4552f186b7db3f51"
)
"""The third point of a face is found among all gates, at points that have several of them."""
CROWDED = bytes.fromhex(
    "09b8a50660000005fc000002c67b38eda41084ce2014a5368ee0b3ae00000000000000000039ea42"
    "6a3f1e8086ba5057360e48a85909584f4acce13715caabe4620cdce533237f8bebc10f10a62fc61c"
    "a9e33a7d4d11de2ef1a139dee8321fb67bebd213998dfe856893346814965776be4aab205fb58a75"
    "1957842302b005802d1a21676142558a6147793cd9b8979e05dfa7f8cc9ead33fa6fad1d6bc24e53"
    "07e746efbcc0547ddd49904393936a789a"
)
"""Points with so many faces that which gate is next depends on the highest count told apart."""
