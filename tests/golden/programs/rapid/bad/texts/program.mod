MODULE M
  VAR num n;
  PROC main()
    TPWrite "open;
    TPWrite 5;
    TPWrite;
    TPWrite "n is"\Num:=n;
    "text";
  ENDPROC
ENDMODULE
