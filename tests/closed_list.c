/* Linked with the list of sources of a shared library: what the list lacks is an error of the linker. */
int main(void)
{
    return 0;
}
