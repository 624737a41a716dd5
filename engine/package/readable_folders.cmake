# SPDX-License-Identifier: Apache-2.0
# Run by CPack before it packs: everybody may enter the folders of a package, whatever the umask under
# which it is made.
file(CHMOD_RECURSE ${CPACK_TEMPORARY_DIRECTORY} DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
