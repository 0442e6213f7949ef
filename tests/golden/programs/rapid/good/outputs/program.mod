MODULE M
  VAR num n;
  PROC main()
    Set do1;
    Reset do1;
    SetDO do2,1;
    SetDO do2,0;
    SetDO do3,high;
    SetDO do_3,low;
    n:=3;
    SetDO do1024,n;
  ENDPROC
ENDMODULE
